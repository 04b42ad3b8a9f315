// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The geometries of a model, made ready for tests of pairs: hulls of meshes, bounding spheres.

#include <memory>
#include <vector>

#include "collision/convex_hull.hpp"
#include "collision/detail/convex_pairs.hpp"
#include "collision/pair_contact.hpp"
#include "engine/constraints/contact_set.hpp"
#include "engine/model/model.hpp"

namespace softgauss::collision::detail {

struct GeometrySet {
  const Model& model;
  std::vector<std::shared_ptr<const ConvexHull>> hull;  ///< null unless a mesh
  std::vector<Collider> colliders;
  std::vector<Vector3> centreInG;  ///< of the bounding sphere [m]
  std::vector<double> radius;      ///< of it; 0 for a plane [m]

  /// Throws ModelError when a mesh has no surface. The model must outlive this.
  GeometrySet(const Model& model, HullCache& hulls);

  const Geometry& geometry(int g) const { return model.geometries[static_cast<std::size_t>(g)]; }
  bool isPlane(int g) const { return geometry(g).shape.kind == ShapeKind::plane; }
  /// At least half of every margin that a pair of this geometry may have: those of materials add
  /// up.
  double marginShare(int g) const;
  /// Contacts of a pair, a's kind ≤ b's, with distance < margin; false where a pose is not finite.
  bool test(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin,
            PairContacts& found) const;
  /// The same, into contacts; failures and tests are counted there.
  void report(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin,
              PairContacts& found, ContactSet& contacts) const;
};

}  // namespace softgauss::collision::detail

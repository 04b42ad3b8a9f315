// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The geometries of a model, made ready for tests of pairs: hulls and surfaces of meshes,
/// bounding spheres.

#include <memory>
#include <vector>

#include "softgauss/collision/detail/convex_pairs.hpp"
#include "softgauss/collision/detail/surface_contacts.hpp"
#include "softgauss/collision/detail/surface_pairs.hpp"
#include "softgauss/collision/pair_contact.hpp"
#include "softgauss/collision/prepared_meshes.hpp"
#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss::collision::detail {

/// What a test of a pair finds, and the memory that it works in.
struct PairTest {
  PairContacts found;             ///< of a pair with a surface, the deepest point alone
  SurfaceContacts surface;        ///< of a pair with a surface
  SurfacePairs pairs;             ///< of a pair of two
  SurfaceReach* reach = nullptr;  ///< of the pair that is tested, where it has one
  const std::vector<PairContact>* points = nullptr;  ///< all of a pair with a surface
  int reduced = 0;                                   ///< left to others beside them

  std::vector<int> scratch;

  template <class Found>
  void take(const Found& from) {
    points = &from.points();
    reduced = from.reduced();
  }
  /// Of the points the one with the least distance; null without points.
  const PairContact* deepest() const;
};

struct GeometrySet {
  const Model& model;
  std::vector<std::shared_ptr<const ConvexHull>> hull;       ///< of meshes, and of triangles that
                                                             ///< move or are convex
  std::vector<std::shared_ptr<const TriangleMesh>> surface;  ///< null unless triangles
  std::vector<Collider> colliders;
  std::vector<Vector3> centreInG;  ///< of the bounding sphere [m]
  std::vector<double> radius;      ///< of it; 0 for a plane [m]

  /// Throws ModelError when a mesh has no surface, or one whose sides are mixed. The model must
  /// outlive this.
  GeometrySet(const Model& model, PreparedMeshes& meshes);

  const Geometry& geometry(int g) const { return model.geometries[static_cast<std::size_t>(g)]; }
  bool isPlane(int g) const { return geometry(g).shape.kind == ShapeKind::plane; }
  /// The hull that collides for a geometry that is a mesh; null for other shapes.
  const ConvexHull* collidingHull(int g) const {
    return geometry(g).shape.kind == ShapeKind::mesh ? hull[static_cast<std::size_t>(g)].get()
                                                     : nullptr;
  }
  /// All hulls and surfaces.
  PreparedMeshes meshes() const;
  /// Of each geometry at least half of every margin that a pair of it may have: those of materials
  /// add up.
  std::vector<double> marginShares() const;
  /// Whether b is no surface, or moves, or has a triangle within `reach` [m] of the bounding sphere
  /// of a, whose centre is p_W.
  bool comesNear(int a, const Vector3& p_W, int b, const Transform& X_WB, double reach) const;
  /// Of two surfaces, one within the other, the one that is pushed out as its hull: what moves, or
  /// else the smaller.
  int hullOf(int a, int b) const;
  /// Contacts of a pair, a's kind ≤ b's, with distance < margin; false where a pose is not finite.
  bool test(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin,
            PairTest& test) const;
  /// The same, into contacts; failures and tests are counted there.
  void report(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin,
              PairTest& test, ContactSet& contacts) const;
  /// Contacts of a convex pair with distance < margin, along n_W from a to b or nearly, into
  /// contacts.
  void reportAlong(int a, const Transform& X_WA, int b, const Transform& X_WB, const Vector3& n_W,
                   double margin, PairTest& test, ContactSet& contacts) const;

 private:
  void addFound(int a, int b, const PairTest& test, ContactSet& contacts) const;
  bool testSurfaces(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin,
                    PairTest& test) const;
  bool testSurface(int a, const Transform& X_WA, int b, const Transform& X_WB, double margin,
                   PairTest& test) const;
};

}  // namespace softgauss::collision::detail

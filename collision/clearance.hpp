// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Distances and nearest points of the shapes of a model, however far apart they are.
///
///   plane and any     the lowest corners over the plane
///   convex shapes     GJK (detail/separating_direction.hpp), on the cores of round ones
///   with a surface    the triangle that is nearest, by its hierarchy of boxes, nearest box first;
///                     then as for convex shapes, with that triangle
/// What overlaps is met as contacts are: its distance is minus the depth of the deepest point.
/// Of a shape and an open surface there is no inside.
///
/// Once its buffers have grown, nothing is allocated. One a thread.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "softgauss/collision/prepared_meshes.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"
#include "softgauss/engine/model/model.hpp"
#include "softgauss/engine/model/shape_distances.hpp"

namespace softgauss::collision {

class Clearance final : public ShapeDistances {
 public:
  /// What `meshes` has is taken from there, the rest is made. Throws ModelError when a mesh has no
  /// surface. The model must outlive this object.
  explicit Clearance(const Model& model, PreparedMeshes meshes = {});
  ~Clearance() override;
  Clearance(const Clearance&) = delete;
  Clearance& operator=(const Clearance&) = delete;

  std::span<const NearPoints> between(int a, const Transform& X_WA, int b,
                                      const Transform& X_WB) noexcept override;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

/// Two links, or one and "world" for all scenery, and how far their shapes are apart.
struct LinkClearance {
  std::string a, b;
  double distance = kInfinity;  ///< [m], unsigned: 0 where they overlap
};

/// Of all pairs of links that move against each other and are not joined by a joint, in the
/// configuration of `kinematics`, nearest first. What is fixed to the world counts by its links.
std::vector<LinkClearance> clearances(const Model& model, const Kinematics& kinematics,
                                      Clearance& distances);

}  // namespace softgauss::collision

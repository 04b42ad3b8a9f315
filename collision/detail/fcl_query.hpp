// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The wall around FCL: what it is asked for one pair of convex shapes.
///
/// FCL 0.7 throws on degenerate configurations and gives one contact; both end here. Spheres and
/// capsules are handed over as their cores (a point, a segment): cores are usually disjoint, where
/// GJK is exact, and the radius is added by the caller.

#include <memory>
#include <optional>

#include "collision/support.hpp"
#include "engine/core/spatial.hpp"

namespace softgauss::collision::detail {

/// FCL's form of a shape, at its own frame G.
class FclShape {
 public:
  FclShape() = default;
  explicit FclShape(const Convex& convex);

  struct Geometry;
  const Geometry* geometry() const { return geometry_.get(); }

 private:
  std::shared_ptr<const Geometry> geometry_;
};

/// A direction along which two cores are apart or overlap least, and where.
struct CoreDirection {
  Vector3 n_W;  ///< unit, from A to B
  Vector3 p_W;  ///< midway between the witness points [m]
};

/// Signed distance of the cores by GJK and EPA, else their penetration by MPR. Nothing when no
/// query answers, or when the cores touch so exactly that they leave the direction open.
std::optional<CoreDirection> coreDirection(const FclShape& a, const Transform& X_WA,
                                           const FclShape& b, const Transform& X_WB,
                                           double size) noexcept;

}  // namespace softgauss::collision::detail

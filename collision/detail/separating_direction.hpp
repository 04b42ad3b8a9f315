// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The direction along which two convex shapes are farthest apart or overlap least.
///
/// With the Minkowski difference D = A − B and its support height h(n) = max over D of n·x, the
/// separation along n is σ(n) = −h(n). Shapes are disjoint when D does not contain the origin:
///   disjoint     n points from the point of D nearest to the origin to the origin      GJK
///   overlapping  n is the normal of the face of D nearest to the origin                EPA
/// (Gilbert, Johnson, Keerthi 1988; van den Bergen, Collision Detection, 2003.) Every direction
/// that is tried costs one support point of D, which tells σ exactly; the best one is returned. So
/// the answer is a true separation even where rounding ends the search early. The number of
/// iterations is bounded and nothing is allocated.
///
/// Spheres and capsules enter as their cores, a point and a segment: cores are mostly disjoint,
/// where the answer is exact.

#include "softgauss/collision/support.hpp"

namespace softgauss::collision::detail {

struct SeparatingDirection {
  Vector3 n_W = Vector3::UnitZ();  ///< unit, from A to B
  double separation = -kInfinity;  ///< σ(n) of the cores [m]
};

/// The best direction, or the first one found with separation ≥ enough. `size` [m] is the scale of
/// the smaller shape, relative to which the search ends.
SeparatingDirection separatingDirection(const Convex& a, const Transform& X_WA, const Convex& b,
                                        const Transform& X_WB, double size, double enough);

}  // namespace softgauss::collision::detail

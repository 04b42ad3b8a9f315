// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/rivals/scene.hpp"

namespace rivals {

/// Signed distance of two shapes at these poses in the world [m]; negative where they overlap.
/// Of two boxes that do not overlap, a lower bound.
double distanceOf(const Shape& a, const Isometry3d& X_WA, const Shape& b, const Isometry3d& X_WB);

/// Height of the lowest point of a shape [m].
double lowestPoint(const Shape& shape, const Isometry3d& X);

/// How deep the deepest overlap is between bodies, or a body and the ground, in these states [m];
/// 0 where there is none.
double deepestOverlap(const Scene& scene, const std::vector<BodyState>& states);

}  // namespace rivals

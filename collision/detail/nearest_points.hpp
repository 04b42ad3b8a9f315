// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Nearest points of two convex shapes that are apart.
///
/// GJK ends with a simplex of D = A − B that carries its point nearest to the origin,
/// v = Σ λ_i w_i, w_i = a_i − b_i; Σ λ_i a_i and Σ λ_i b_i are then the nearest points of the cores
/// of A and B (Gilbert, Johnson, Keerthi 1988), and the shapes' own are their radii further on.

#include "softgauss/collision/detail/convex_pairs.hpp"
#include "softgauss/engine/model/shape_distances.hpp"

namespace softgauss::collision::detail {

/// False where the cores touch, or a number is not finite; `found` then says nothing. Of shapes
/// farther apart than `enough` the search may end early, with nothing but a distance that is too
/// small and ≥ enough.
bool nearestPoints(const Collider& a, const Transform& X_WA, const Collider& b,
                   const Transform& X_WB, double enough, NearPoints& found);

}  // namespace softgauss::collision::detail

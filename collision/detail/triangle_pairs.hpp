// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How two triangles lie to each other.
///
/// The difference of two triangles is a polytope whose faces have the normals of the two or lie
/// along a side of each. So the direction in which two triangles that overlap do so least is one of
/// these. For two that are apart or in one plane the directions within their planes, across their
/// sides, are tried as well.  (Separating axes: Gottschalk, Lin and Manocha, OBBTree, SIGGRAPH
/// 1996.)

#include "softgauss/collision/detail/convex_pairs.hpp"

namespace softgauss::collision::detail {

/// Of two triangles in one frame: the best direction, from a to b, and the separation along it.
/// Normals of the two come first, to rounding. Once they are `enough` apart along one [m], no other
/// direction is looked for.
Separation separateTriangles(const Triangle& a, const Triangle& b, double enough = kInfinity);

/// min over b of n·x − max over a of n·x.
double separationAlong(const Triangle& a, const Triangle& b, const Vector3& n);

}  // namespace softgauss::collision::detail

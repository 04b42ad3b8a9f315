// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Mass and inertia of a mesh, as the attribute inertia of <mesh> has them.
///
/// Pyramids between each triangle and a point: exact sums their signed volumes, legacy, the
/// default, their sizes, about the centroid of the faces, which is exact for what is star-shaped
/// about that. shell is the surface alone; its centre of mass is a quarter of the way from the
/// mean of the faces' to itself, which is the same point.

#include "softgauss/io/mjcf/asset.hpp"

namespace softgauss::io::mjcf {

/// Sets unit, X_FP and problem from mesh and inertia.
void weighMesh(MeshAsset& asset);

}  // namespace softgauss::io::mjcf

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// URDF has no capsule: robots write a cylinder and two spheres of its radius at its ends.
///
/// Such a triple is one capsule, and simulates as one: three shapes would make three contacts where
/// there is one. A sphere may cap several cylinders of its link (a bent tube); it goes as soon as
/// one of them has become a capsule, which contains it.

#include <vector>

#include "softgauss/engine/model/model_builder.hpp"

namespace softgauss {

/// Lengths are equal when they differ by less than this part of the cylinder's size.
inline constexpr double kCapsuleTolerance = 1e-6;

/// The geometries with every cylinder whose two ends are capped turned into a capsule and the caps
/// removed; order, names and everything else are kept. A cap is a sphere of the same link, radius
/// and material whose centre is that of the cylinder's end.
std::vector<GeometrySpec> recogniseCapsules(std::vector<GeometrySpec> geometries);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Corners of triangles that are one point but for rounding.
///
/// A closed surface whose seam was computed twice, by cos 0 and cos 2 π say, has two columns of
/// points there, 10⁻¹⁷ m apart. Coordinates have the precision of single numbers, in files and as
/// they are imported: points are told apart from 2⁻²³ of the largest coordinate on.

#include "softgauss/engine/model/shape.hpp"

namespace softgauss::io::detail {

/// Joins points no farther apart than that in every coordinate: the first of them stays. Meshes
/// without such points are as they were.
void joinRoundedPoints(Mesh& mesh);

}  // namespace softgauss::io::detail

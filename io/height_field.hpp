// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Landscapes: heights above the points of a grid, as a solid of triangles.
///
/// The grid fills a rectangle about the origin. Its first row is that of the largest y, as on a
/// map, its first column that of the least x. Each cell is two triangles. Walls go down from the
/// rim to a flat bottom, so that what is below the surface is inside a solid and is pushed out.

#include <filesystem>
#include <vector>

#include "softgauss/engine/model/shape.hpp"

namespace softgauss::io {

struct Heights {
  int rows = 0, columns = 0;   ///< ≥ 2
  std::vector<double> values;  ///< (rows × columns)
};

/// What of a .png is a level: one of grey alone, or the red of one that has colours.
enum class PngLevels { grey, red };

/// Grey levels of a .png, 0 black to 1 white, or the numbers of a .csv, a line for each row. Throws
/// ModelError naming file and line where the file cannot be read, a number is none, rows differ in
/// length, or there are fewer than two rows or columns or more than four million values.
Heights readHeights(const std::filesystem::path& file, PngLevels levels = PngLevels::grey);

/// The solid over a rectangle of size x by y [m], its surface at `scale` times the values [m]. The
/// bottom is `base` [m], > 0, below the lowest of them.
Mesh heightFieldMesh(const Heights& heights, double x, double y, double scale, double base);

}  // namespace softgauss::io

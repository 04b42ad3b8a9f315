// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Grey levels of PNG images (ISO/IEC 15948).

#include <string>
#include <vector>

namespace softgauss::io::detail {

/// Grey levels, 0 black to 1 white, row by row from the top.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<double> levels;  ///< (height × width)
};

/// Reads a grey PNG of 8 or 16 bits, not interlaced; with `redOfColours` one of colours or
/// transparency too, of which the red, or the grey, is the level. Throws ModelError naming `file`
/// where `bytes` are no such image, with what was found.
GreyImage readGreyPng(const std::string& file, const std::string& bytes, bool redOfColours = false);

}  // namespace softgauss::io::detail

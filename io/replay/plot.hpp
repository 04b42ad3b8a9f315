// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The curves of a run drawn by gnuplot, for print: axes with units, at the scale of the
/// curves; limits that are near are dashed.
///
/// A file `.svg` holds all groups of curves, a folder one file a group. Groups whose curves have
/// limits, or that are many, are drawn as a grid with a small drawing for each curve.

#include <filesystem>
#include <optional>

#include "softgauss/io/detail/output_file.hpp"
#include "softgauss/io/replay/recording.hpp"

namespace softgauss::io {

class Plot {
 public:
  /// Makes the folder, or makes sure that the file can be written. Throws ModelError when it
  /// cannot, when the name has another extension than .svg, or when there is no gnuplot.
  explicit Plot(const std::filesystem::path& target);

  /// Throws std::runtime_error when gnuplot fails or the disk is full.
  void write(const Recording& recording);

 private:
  std::filesystem::path target_;
  std::optional<detail::OutputFile> file_;  ///< absent: a folder
};

/// The script that gnuplot is given for one drawing, data included.
std::string plotScript(const Recording& recording, const std::vector<CurveGroup>& groups);

}  // namespace softgauss::io

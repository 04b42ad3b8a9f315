// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Work-precision diagrams: error against time, one curve per method, a marker per step size.

#include <filesystem>

#include "apps/accuracy_cost/study.hpp"

namespace softgauss::app {

/// <problem>.svg for each problem, by gnuplot where it is found, and accuracy_cost.html with all of
/// them, a table, and an answer to "which setting for this accuracy". Throws std::runtime_error
/// where a file cannot be written.
void writePictures(const std::filesystem::path& folder, const std::vector<Problem>& problems,
                   const std::vector<Result>& results);

/// The page, with a place for its data.
std::string pageTemplate();

}  // namespace softgauss::app

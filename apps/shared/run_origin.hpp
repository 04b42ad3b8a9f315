// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a run is made from: program, machine and files.

#include <filesystem>
#include <string>
#include <vector>

#include "softgauss/io/summary.hpp"

namespace softgauss::app {

/// With the commit that the sources had when they were configured. Files that are named twice are
/// told once, empty paths not at all.
io::RunOrigin runOrigin(const std::string& commandLine, std::vector<std::filesystem::path> files);

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// SHA-256 of files, as `sha256sum` has it.

#include <filesystem>
#include <string>

namespace softgauss::app {

/// Hexadecimal; empty where the file cannot be read.
std::string sha256(const std::filesystem::path& file);

}  // namespace softgauss::app

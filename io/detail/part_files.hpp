// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Files that are being written beside the place they are for. io::removePartFiles() in
/// io/output.hpp removes them when a signal ends the process.

#include <filesystem>

namespace softgauss::io::detail {

/// A name for a new file in the folder of `target`, of this process alone; remembered until it is
/// forgotten.
std::filesystem::path rememberPart(const std::filesystem::path& target);
void forgetPart(const std::filesystem::path& part) noexcept;

}  // namespace softgauss::io::detail

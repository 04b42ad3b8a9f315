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

/// Makes such a file and holds a lock on it as long as the descriptor, or a copy of it, is open.
/// −1: it cannot, errno says why.
int makePart(const std::filesystem::path& target, std::filesystem::path& part);

/// Removes from the folder of `target` those that nobody writes any more, as a process has left
/// them that was killed (kill -9). Looks once where it is asked again about the same folder.
void removeLeftParts(const std::filesystem::path& target);

}  // namespace softgauss::io::detail

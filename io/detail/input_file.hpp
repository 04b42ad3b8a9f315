// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Text that is read: from regular files, never from what has no end or waits for a writer.

#include <cstdint>
#include <optional>
#include <string>

namespace softgauss::io::detail {

/// What messages call the file.
std::string inputName(const std::string& file);

/// Why a file cannot be read, as a message goes on: "is a named pipe, not a regular file"; nothing
/// where it can. Never waits.
std::string inputProblem(const std::string& file);

/// All of a regular file, or of standard input, which is read once and remembered. Throws
/// ModelError `file: file: is …, expected <expected>` where it is none, cannot be read, or is
/// larger than inputLimits() allow, or than `most` bytes where that is given.
std::string readInput(const std::string& file, const std::string& expected,
                      std::optional<std::uintmax_t> most = {});

}  // namespace softgauss::io::detail

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a program that writes outputs needs beside them.

#include <filesystem>
#include <string>

namespace softgauss::io {

/// Whether the name stands for standard output: "-", or its device.
bool isStandardOutput(const std::filesystem::path& file);

/// Throws ModelError where an output cannot be made or written, and leaves everything as it is.
/// `what` names it in the message.
void expectWritable(const std::filesystem::path& file, const std::string& what);

/// Removes outputs that are half written, for a signal handler that is about to end the process:
/// async-signal-safe.
void removePartFiles() noexcept;

}  // namespace softgauss::io

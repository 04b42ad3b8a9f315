// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Work whose time and memory nobody can bound beforehand, done in a child process that has bounds.

#include <cstdint>
#include <functional>
#include <string>

namespace softgauss::io::detail {

struct ChildLimits {
  int seconds = 10;                   ///< of processor time
  std::uint64_t bytes = 1024u << 20;  ///< beyond what this process has
};

struct ChildResult {
  std::string bytes;    ///< what `work` returned
  std::string failure;  ///< why it did not return, "needs more than 10 s"; empty if it did
};

/// Calls `work` in a fork of this process. It must not throw anything but std::bad_alloc, nor need
/// another thread. What it prints is lost. A crash of it is a failure like any other.
ChildResult runInChild(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace softgauss::io::detail

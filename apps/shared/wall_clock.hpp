// SPDX-License-Identifier: Apache-2.0
#pragma once
/// Wall time, which never runs backwards.

#include <chrono>

namespace softgauss::app {

using Clock = std::chrono::steady_clock;

/// [s]
inline double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// When a solve is to end with the best that it has.

#include <chrono>

#include "softgauss/engine/core/check.hpp"

namespace softgauss::gdd {

/// A moment of the monotonic clock, which is read once an iteration; not at all where there is
/// none.
class Deadline {
 public:
  /// Never.
  Deadline() = default;
  /// `seconds` from now; infinity: never.
  static Deadline in(double seconds) {
    Deadline deadline;
    if (seconds < kInfinity)
      deadline.at_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(seconds));
    return deadline;
  }
  bool isOver() const { return at_ != Clock::time_point::max() && Clock::now() >= at_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point at_ = Clock::time_point::max();
};

}  // namespace softgauss::gdd

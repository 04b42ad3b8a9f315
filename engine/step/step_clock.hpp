// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// Reads the clock where Data::timed, and never else.
class StepClock {
 public:
  explicit StepClock(const Data& data) : runs_(data.timed) { lap(); }
  /// Seconds since the last lap; 0 where no clock is read.
  double lap() {
    if (!runs_) return 0.0;
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool runs_;
  Clock::time_point last_;
};

}  // namespace softgauss

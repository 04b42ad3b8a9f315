// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Keeps simulated time in step with the clock.

#include <chrono>

namespace softgauss::live {

class Pace {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr double kMostLag = 0.1;  ///< [s] what is later than that is given up

  /// From here on `time` is now.
  void restart(double time) {
    start_ = Clock::now();
    from_ = time;
  }
  /// When the state of `time` is due. A run that cannot keep up does not hurry after the clock.
  Clock::time_point due(double time, double factor) {
    if (factor != factor_ || time < from_) {
      factor_ = factor;
      restart(time);
    }
    const auto at = start_ + std::chrono::duration_cast<Clock::duration>(
                                 std::chrono::duration<double>((time - from_) / factor));
    if (Clock::now() - at < std::chrono::duration<double>(kMostLag)) return at;
    restart(time);
    return start_;
  }
  /// Simulated over real time since the last call.
  double reached(double time) {
    const Clock::time_point now = Clock::now();
    const double passed = std::chrono::duration<double>(now - lookedAt_).count();
    const double rate = passed > 0.0 ? (time - lookedFrom_) / passed : 0.0;
    lookedAt_ = now;
    lookedFrom_ = time;
    return rate;
  }

 private:
  Clock::time_point start_ = Clock::now();
  double from_ = 0.0, factor_ = 1.0;
  Clock::time_point lookedAt_ = Clock::now();
  double lookedFrom_ = 0.0;
};

}  // namespace softgauss::live

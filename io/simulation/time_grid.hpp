// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Times of steps without the rounding of sums: k h from where the first one began.

#include <cmath>

namespace softgauss {

/// Steps of `h` [s] that it takes to be at least `seconds` on, rounding apart.
inline long stepsIn(double seconds, double h) {
  constexpr double kRounding = 1e-9;  // of a step
  return static_cast<long>(std::ceil(seconds / h - kRounding));
}

class TimeGrid {
 public:
  /// A step of `h` from `time` ends there [s].
  double after(double time, double h) {
    if (time != last_ || h != h_) origin_ = time, steps_ = 0, h_ = h;
    return last_ = origin_ + static_cast<double>(++steps_) * h;
  }

  template <class Archive>
  void archive(Archive& a) {
    a(origin_, last_, h_, steps_);
  }

 private:
  double origin_ = 0.0, last_ = 0.0, h_ = 0.0;
  long steps_ = 0;
};

}  // namespace softgauss

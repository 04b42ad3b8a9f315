// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How the error of a run grows, by what it was in a trial that is shorter.
///
///   e(t) ≈ c t^p
///
/// Least squares of log e over log t, of eight equal windows, each with its root mean square. What
/// errs in every step by itself grows with p = 1 or less, a phase with 2. Where e(t) ≈ c exp(λ t)
/// fits far better the motion is chaotic: nothing can be said of later times.

#include <vector>

namespace softgauss::app {

struct Growth {
  double power = 1.0;    ///< p
  double scale = 0.0;    ///< c [m/s^p]
  double rate = 0.0;     ///< λ of the other fit [1/s]
  bool chaotic = false;  ///< the other fit is far better, and grows tenfold or more
  double largest = 0.0;  ///< of the errors seen [m]

  /// The error that is expected at a time after the trial [m].
  double at(double time) const;
};

/// `errors` [m]: of samples at equal distances, the last at `duration` [s].
Growth growthOf(const std::vector<double>& errors, double duration);

}  // namespace softgauss::app

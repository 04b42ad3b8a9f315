// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The embedded Runge–Kutta pair of Dormand and Prince, order 5 with an error estimate of order 4
/// [Dormand, Prince 1980], and the choice of its step (T.90):
///
///   k_i = f(y + h Σ_{j<i} a_ij k_j),   y⁺ = y + h Σ_i a_7i k_i,   e = h Σ_i e_i k_i,   i = 1 … 7
///   h ← h clamp(0.9 (tolerance/‖e‖)^(1/5), 0.2, 5)
///
/// The last stage is f(y⁺), the first one of the next step.

#include <algorithm>
#include <array>
#include <cmath>

namespace softgauss {

struct DormandPrince {
  static constexpr int kStages = 7;
  /// Row i: a_ij of stage i + 1 (from 0); the last row is the solution of order 5.
  static constexpr double kA[6][6] = {
      {1.0 / 5.0, 0, 0, 0, 0, 0},
      {3.0 / 40.0, 9.0 / 40.0, 0, 0, 0, 0},
      {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0, 0, 0},
      {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0, 0},
      {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0},
      {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0}};
  /// Solution of order 5 less that of order 4.
  static constexpr double kE[7] = {
      71.0 / 57600.0,      0.0,          -71.0 / 16695.0, 71.0 / 1920.0,
      -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0};
  /// Where in the step each stage is.
  static constexpr double kC[7] = {0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0};

  /// Factor for the next step after an error of `ratio` = ‖e‖/tolerance.
  static double stepFactor(double ratio) {
    if (!(ratio > 0.0)) return std::isnan(ratio) ? 0.2 : 5.0;
    return std::clamp(0.9 * std::pow(ratio, -0.2), 0.2, 5.0);
  }
};

}  // namespace softgauss

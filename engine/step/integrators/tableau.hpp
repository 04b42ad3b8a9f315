// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Coefficients of explicit Runge–Kutta methods (7.4):
///
///   k_i = f(t + c_i h, y + h Σ_{j<i} a_ij k_j),   y⁺ = y + h Σ_i b_i k_i,   e = h Σ_i e_i k_i
///
/// e is the difference to a second result of lower order; it estimates the error of that one.

#include <algorithm>
#include <array>
#include <cmath>

namespace softgauss {

struct Tableau {
  static constexpr int kMostStages = 7;
  int stages = 0;
  int order = 0;
  std::array<std::array<double, 6>, kMostStages> a{};
  std::array<double, kMostStages> b{}, e{};
  bool embedded = false;    ///< e is there
  bool lastIsNext = false;  ///< the last stage is f(y⁺), the first of the next step
};

/// The classical method of order 4 [Kutta 1901].
inline constexpr Tableau kRungeKutta4{4,
                                      4,
                                      {{{}, {0.5}, {0.0, 0.5}, {0.0, 0.0, 1.0}}},
                                      {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0},
                                      {},
                                      false,
                                      false};

/// Order 5 with an estimate of order 4 [Dormand, Prince 1980].
inline constexpr Tableau kDormandPrince{
    7,
    5,
    {{{},
      {1.0 / 5.0},
      {3.0 / 40.0, 9.0 / 40.0},
      {44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0},
      {19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0},
      {9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0},
      {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0}}},
    {35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0, 0.0},
    {71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0,
     -1.0 / 40.0},
    true,
    true};

/// What the next step is longer by after an error of `ratio` times the tolerance; the least where
/// that is not a number.
inline double stepFactor(double ratio, int order) {
  constexpr double kSafety = 0.9, kLeast = 0.2, kMost = 5.0;
  if (!std::isfinite(ratio)) return kLeast;
  if (!(ratio > 0.0)) return kMost;
  return std::clamp(kSafety * std::pow(ratio, -1.0 / order), kLeast, kMost);
}

}  // namespace softgauss

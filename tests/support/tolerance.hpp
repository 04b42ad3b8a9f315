// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Tolerances that a developer can turn down: the environment variable TOL_SCALE multiplies all of
/// them, so that TOL_SCALE=0 makes every comparison print its true residual.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

namespace softgauss::test {

inline constexpr double kUnitRounding = 1e-15;  ///< a few roundings of numbers of size 1
inline constexpr double kRounding = 1e-14;      ///< a few roundings of sums of products of size 10

inline double toleranceScale() {
  static const double scale = [] {
    const char* text = std::getenv("TOL_SCALE");
    return text ? std::atof(text) : 1.0;
  }();
  return scale;
}

/// |residual| ≤ tolerance · TOL_SCALE; false for NaN.
inline testing::AssertionResult isSmall(const char* expression, const char*, double residual,
                                        double tolerance) {
  if (std::abs(residual) <= tolerance * toleranceScale()) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << "residual " << residual << ", tolerance " << tolerance << ", of " << expression;
}

}  // namespace softgauss::test

#define EXPECT_SMALL(residual, tolerance) \
  EXPECT_PRED_FORMAT2(::softgauss::test::isSmall, residual, tolerance)
#define ASSERT_SMALL(residual, tolerance) \
  ASSERT_PRED_FORMAT2(::softgauss::test::isSmall, residual, tolerance)

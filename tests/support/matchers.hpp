// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Comparisons of vectors and matrices that tell the worst entry.

#include "softgauss/engine/core/types.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {

/// max |actual − expected| ≤ tolerance · TOL_SCALE · max(1, max |expected|); false for NaN and for
/// different sizes.
inline testing::AssertionResult isApprox(const char* actualText, const char* expectedText,
                                         const char*, const MatrixX& actual,
                                         const MatrixX& expected, double tolerance) {
  if (actual.rows() != expected.rows() || actual.cols() != expected.cols())
    return testing::AssertionFailure()
           << actualText << " is " << actual.rows() << " × " << actual.cols() << ", "
           << expectedText << " is " << expected.rows() << " × " << expected.cols();
  if (actual.size() == 0) return testing::AssertionSuccess();
  const double scale = std::max(1.0, expected.cwiseAbs().maxCoeff());
  Eigen::Index row = 0, col = 0;
  double worst = -1.0;
  for (Eigen::Index j = 0; j < actual.cols(); ++j)
    for (Eigen::Index i = 0; i < actual.rows(); ++i) {
      const double error = std::abs(actual(i, j) - expected(i, j)) / scale;
      if (error <= worst) continue;  // not so for NaN, which is the worst
      row = i, col = j, worst = error;
      if (std::isnan(error)) goto found;
    }
found:
  if (worst <= tolerance * toleranceScale()) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << "residual " << worst << ", tolerance " << tolerance << " relative to " << scale
         << "; worst entry (" << row << ", " << col << "): " << actualText << " = "
         << actual(row, col) << ", " << expectedText << " = " << expected(row, col);
}

}  // namespace softgauss::test

#define EXPECT_APPROX(actual, expected, tolerance) \
  EXPECT_PRED_FORMAT3(::softgauss::test::isApprox, actual, expected, tolerance)
#define ASSERT_APPROX(actual, expected, tolerance) \
  ASSERT_PRED_FORMAT3(::softgauss::test::isApprox, actual, expected, tolerance)

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/solver/line_search.hpp"

#include "softgauss/engine/constraints/rows.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {
namespace {

TEST(LineSearch, QuadraticIsMinimisedAtItsVertex) {
  for (const double vertex : {1e-6, 0.3, 1.0, 7.0, 1e8}) {
    const auto along = [&](double alpha) { return Jet{0.0, 2 * (alpha - vertex), 2.0}; };
    const LineSearchResult result = exactLineSearch(along, along(0.0).slope);
    EXPECT_SMALL(result.alpha / vertex - 1.0, 1e-9);
    EXPECT_LE(result.evaluations, 3);
  }
}

// Random sums of half quadratics and a quadratic: the slope vanishes at the result.
TEST(LineSearch, PiecewiseQuadraticIsMinimisedExactly) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    ScalarRows<HalfQuadratic> rows;
    rows.resizeRows(30);
    for (std::size_t i = 0; i < 30; ++i) {
      rows.D[i] = std::exp(random.uniform(-5.0, 10.0));
      rows.x[i] = random.uniform(-5.0, 5.0);
      rows.dx[i] = random.uniform(-5.0, 5.0);
    }
    const double curvature = std::exp(random.uniform(-3.0, 3.0));
    const double slope = -std::exp(random.uniform(0.0, 10.0));
    const auto along = [&](double alpha) {
      Jet jet{0.0, slope + alpha * curvature, curvature};
      rows.along(alpha, jet);
      return jet;
    };
    const double slope0 = along(0.0).slope;
    if (!(slope0 < 0.0)) continue;
    const LineSearchResult result = exactLineSearch(along, slope0);
    EXPECT_GT(result.alpha, 0.0);
    EXPECT_SMALL(along(result.alpha).slope / slope0, 1e-10);
    EXPECT_LT(result.evaluations, 20);
  }
}

// Smooth but not quadratic: log cosh, whose Newton steps overshoot without the bracket.
TEST(LineSearch, OtherConvexFunctionsConverge) {
  const auto along = [](double alpha) {
    const double x = 5.0 * (alpha - 3.0), t = std::tanh(x);
    return Jet{std::log(std::cosh(x)) / 5.0, t, 5.0 * (1.0 - t * t)};
  };
  const LineSearchResult result = exactLineSearch(along, along(0.0).slope);
  EXPECT_SMALL(result.alpha - 3.0, 1e-9);
}

TEST(LineSearch, WithoutDescentTakesNoStep) {
  const auto along = [](double alpha) { return Jet{0.0, 1.0 + alpha, 1.0}; };
  for (const double slope0 : {0.0, 1.0, std::nan("")}) {
    const LineSearchResult result = exactLineSearch(along, slope0);
    EXPECT_EQ(result.alpha, 0.0);
    EXPECT_EQ(result.evaluations, 0);
  }
}

// A slope that never becomes positive ends after a bounded number of evaluations.
TEST(LineSearch, UnboundedDescentEnds) {
  const auto along = [](double) { return Jet{0.0, -1.0, 0.0}; };
  EXPECT_LE(exactLineSearch(along, -1.0).evaluations, 60);
}

}  // namespace
}  // namespace softgauss::test

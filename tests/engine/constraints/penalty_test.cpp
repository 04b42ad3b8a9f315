// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/penalty.hpp"

#include "engine/constraints/rows.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

template <class Penalty>
class PenaltyLaws : public testing::Test {};
using Penalties = testing::Types<HalfQuadratic>;
TYPED_TEST_SUITE(PenaltyLaws, Penalties);

// Both pieces, and points near the knot on either side.
constexpr double kPoints[] = {-30.0, -1.0, -1e-3, 1e-3, 0.5, 20.0};
constexpr double kStiffness[] = {0.2, 1.0, 350.0};

TYPED_TEST(PenaltyLaws, SlopeIsGradientOfValue) {
  const double h = 1e-6;
  for (const double x : kPoints)
    for (const double D : kStiffness) {
      const double difference =
          (TypeParam::at(x + h, D).value - TypeParam::at(x - h, D).value) / (2 * h);
      // Rounding of the value over 2e-6, relative to its size.
      EXPECT_SMALL((TypeParam::at(x, D).slope - difference) / (D * (1 + x * x)), 1e-9);
    }
}

TYPED_TEST(PenaltyLaws, CurvatureIsGradientOfSlope) {
  const double h = 1e-6;
  for (const double x : kPoints)
    for (const double D : kStiffness) {
      const double difference =
          (TypeParam::at(x + h, D).slope - TypeParam::at(x - h, D).slope) / (2 * h);
      EXPECT_SMALL((TypeParam::at(x, D).curvature - difference) / D, 1e-8);
    }
}

TYPED_TEST(PenaltyLaws, ValueAndSlopeAreContinuousAtTheKnot) {
  for (const double D : kStiffness) {
    const Jet below = TypeParam::at(-1e-12, D), at = TypeParam::at(0.0, D),
              above = TypeParam::at(1e-12, D);
    EXPECT_LE(std::abs(below.value - above.value), 1e-20 * D);
    EXPECT_LE(std::abs(below.slope - above.slope), 2e-12 * D);
    EXPECT_EQ(at.value, above.value);
    EXPECT_EQ(at.slope, above.slope);
    EXPECT_EQ(at.curvature, above.curvature);  // the free side's
  }
}

TYPED_TEST(PenaltyLaws, IsConvexAndNotNegative) {
  for (const double D : kStiffness) {
    double previous = -1e300;
    for (const double x : kPoints) {
      const Jet s = TypeParam::at(x, D);
      EXPECT_GE(s.value, 0.0);
      EXPECT_GE(s.curvature, 0.0);
      EXPECT_GE(s.slope, previous);
      previous = s.slope;
    }
  }
}

TYPED_TEST(PenaltyLaws, NanStaysNan) {
  const Jet s = TypeParam::at(kNaN, 1.0);
  EXPECT_TRUE(std::isnan(s.value) && std::isnan(s.slope));
}

TYPED_TEST(PenaltyLaws, KnotAheadIsWhereTheCurvatureJumps) {
  const double D = 3.0;
  for (const double x : kPoints)
    for (const double dx : {-2.0, -0.1, 0.1, 2.0}) {
      const double alpha = TypeParam::knotAhead(x, dx);
      if (alpha == kInfinity) {
        EXPECT_EQ(TypeParam::at(x, D).curvature, TypeParam::at(x + 1e6 * dx, D).curvature);
        continue;
      }
      ASSERT_GE(alpha, 0.0);
      const double before = TypeParam::at(x + (alpha * (1 - 1e-9)) * dx, D).curvature;
      const double after = TypeParam::at(x + (alpha * (1 + 1e-9)) * dx, D).curvature;
      EXPECT_EQ(after - before, TypeParam::curvatureJump(dx, D));
    }
}

TEST(HalfQuadratic, PullsOnOneSideOnly) {
  EXPECT_EQ(HalfQuadratic::at(-2.0, 3.0).value, 6.0);
  EXPECT_EQ(-HalfQuadratic::at(-2.0, 3.0).slope, 6.0);  // force D·2 ≥ 0
  EXPECT_EQ(HalfQuadratic::at(2.0, 3.0).value, 0.0);
  EXPECT_EQ(HalfQuadratic::at(2.0, 3.0).slope, 0.0);
}

// ---- Rows
// ----------------------------------------------------------------------------------------

ScalarRows<HalfQuadratic> sampleRows() {
  ScalarRows<HalfQuadratic> rows;
  rows.resizeRows(4);
  rows.D = {1.0, 2.0, 0.5, 3.0};
  rows.x = {-1.0, 0.5, -0.2, 2.0};
  rows.dx = {0.4, -1.0, -0.3, 0.7};
  return rows;
}

TEST(Rows, CostIsTheSumAndForceTheNegativeSlope) {
  ScalarRows<HalfQuadratic> rows = sampleRows();
  bool changed = false;
  EXPECT_SMALL(rows.evaluate(changed) - (0.5 + 0.5 * 0.5 * 0.04), 1e-16);
  EXPECT_EQ(rows.f, (std::vector<double>{1.0, 0.0, 0.1, 0.0}));
  EXPECT_EQ(rows.h, (std::vector<double>{1.0, 0.0, 0.5, 0.0}));
}

TEST(Rows, EvaluateTellsWhetherACellWasLeft) {
  ScalarRows<HalfQuadratic> rows = sampleRows();
  bool changed = false;
  rows.evaluate(changed);
  changed = false;
  rows.advance(0.1);
  rows.evaluate(changed);
  EXPECT_FALSE(changed);
  rows.advance(1.0);  // the second row crosses its knot
  rows.evaluate(changed);
  EXPECT_TRUE(changed);
}

TEST(Rows, AlongTheRayIsTheCostThere) {
  const ScalarRows<HalfQuadratic> rows = sampleRows();
  for (const double alpha : {0.0, 0.3, 0.7, 4.0}) {
    Jet jet{};
    rows.along(alpha, jet);
    ScalarRows<HalfQuadratic> moved = rows;
    moved.advance(alpha);
    bool changed = false;
    EXPECT_SMALL(jet.value - moved.evaluate(changed), 1e-15);
    double slope = 0.0, curvature = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      slope -= moved.f[i] * moved.dx[i];
      curvature += moved.h[i] * moved.dx[i] * moved.dx[i];
    }
    EXPECT_SMALL(jet.slope - slope, 1e-15);
    EXPECT_SMALL(jet.curvature - curvature, 1e-15);
  }
}

}  // namespace
}  // namespace softgauss::test

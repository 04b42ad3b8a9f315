// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/penalty.hpp"

#include "softgauss/engine/constraints/rows.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

template <class Penalty>
class PenaltyLaws : public testing::Test {};
using Penalties = testing::Types<HalfQuadratic, Quadratic, Huber>;
TYPED_TEST_SUITE(PenaltyLaws, Penalties);

constexpr double kStiffness[] = {0.2, 1.0, 350.0};

/// Huber's breakpoints are at ∓ 2.
template <class Penalty>
Penalty make(double D) {
  if constexpr (Penalty::kLimited)
    return {D, 2.0 * D};
  else
    return {D};
}

// Every piece, and points near the breakpoints on either side.
constexpr double kPoints[] = {-30.0, -2.001, -1.999, -1.0, -1e-3, 1e-3, 0.5, 1.999, 2.001, 20.0};

TYPED_TEST(PenaltyLaws, SlopeIsGradientOfValue) {
  const double h = 1e-6;
  for (const double x : kPoints)
    for (const double D : kStiffness) {
      const TypeParam s = make<TypeParam>(D);
      const double difference = (s.at(x + h).value - s.at(x - h).value) / (2 * h);
      // Rounding of the value over 2e-6, relative to its size.
      EXPECT_SMALL((s.at(x).slope - difference) / (D * (1 + x * x)), 1e-9);
    }
}

TYPED_TEST(PenaltyLaws, CurvatureIsGradientOfSlope) {
  const double h = 1e-6;
  for (const double x : kPoints)
    for (const double D : kStiffness) {
      const TypeParam s = make<TypeParam>(D);
      const double difference = (s.at(x + h).slope - s.at(x - h).slope) / (2 * h);
      EXPECT_SMALL((s.at(x).curvature - difference) / D, 1e-8);
    }
}

TYPED_TEST(PenaltyLaws, ValueAndSlopeAreContinuousAtTheKnots) {
  for (const double D : kStiffness) {
    const TypeParam s = make<TypeParam>(D);
    for (int k = 0; k < TypeParam::kBreakpoints; ++k) {
      const double x = s.breakpoint(k);
      const Jet below = s.at(x - 1e-12), at = s.at(x), above = s.at(x + 1e-12);
      EXPECT_LE(std::abs(below.value - above.value), 1e-11 * D);
      EXPECT_LE(std::abs(below.slope - above.slope), 3e-12 * D);
      EXPECT_EQ(at.curvature, 0.0);  // counted as free
    }
  }
}

TYPED_TEST(PenaltyLaws, IsConvexAndNotNegative) {
  for (const double D : kStiffness) {
    const TypeParam s = make<TypeParam>(D);
    double previous = -1e300;
    for (const double x : kPoints) {
      EXPECT_GE(s.at(x).value, 0.0);
      EXPECT_GE(s.at(x).curvature, 0.0);
      EXPECT_GE(s.at(x).slope, previous);
      previous = s.at(x).slope;
    }
  }
}

TYPED_TEST(PenaltyLaws, NanStaysNan) {
  const Jet s = make<TypeParam>(1.0).at(kNaN);
  EXPECT_TRUE(std::isnan(s.value) && std::isnan(s.slope));
}

TYPED_TEST(PenaltyLaws, PiecesMeetAtTheKnotsWhereTheCurvatureJumps) {
  const TypeParam s = make<TypeParam>(3.0);
  int piece = s.piece(-1e6);
  EXPECT_EQ(piece, 0);
  for (int k = 0; k < TypeParam::kBreakpoints; ++k) {
    const double x = s.breakpoint(k);
    EXPECT_EQ(s.piece(x - 1e-9), k);
    EXPECT_EQ(s.piece(x + 1e-9), k + 1);
    EXPECT_EQ(s.at(x + 1e-9).curvature - s.at(x - 1e-9).curvature, s.curvatureJump(k));
    EXPECT_EQ(s.at(s.breakpoint(k)).curvature, 0.0);
  }
  EXPECT_EQ(s.piece(1e6), TypeParam::kBreakpoints);
}

// The crossings found on a ray are the places where the curvature changes along it, in their order.
TYPED_TEST(PenaltyLaws, CrossingsAreWhereTheCurvatureJumpsAlongTheRay) {
  int found = 0;
  for (const double x : {-30.0, -2.0, -1.0, 0.0, 0.5, 2.0, 20.0})
    for (const double dx : {-2.0, -0.1, 0.0, 0.1, 2.0}) {
      ScalarRows<TypeParam> rows;
      if (TypeParam::kLimited) rows.limit = {6.0};
      rows.resizeRows(1);
      rows.D = {3.0};
      rows.x = {x};
      rows.dx = {dx};
      const TypeParam s = rows.penalty(0);
      std::vector<Crossing> crossings;
      rows.findCrossings(4, crossings);
      double curvature = s.at(x).curvature, last = 0.0;
      for (const Crossing& c : crossings) {
        ++found;
        EXPECT_GE(c.alpha, last);
        EXPECT_EQ(c.rate, dx);
        EXPECT_EQ(c.breakpoint.row, (RowId{4, 0}));
        EXPECT_SMALL(x + c.alpha * dx - s.breakpoint(c.breakpoint.index), 1e-12);
        curvature += c.curvatureJump;
        EXPECT_EQ(s.at(x + (c.alpha + 1e-6) * dx).curvature, curvature);
        last = c.alpha;
      }
      EXPECT_EQ(s.at(x + 1e6 * dx).curvature, curvature);
    }
  EXPECT_EQ(found > 0, TypeParam::kBreakpoints > 0);
}

TYPED_TEST(PenaltyLaws, RowsArePlacedAtTheirKnotsOnEitherSide) {
  ScalarRows<TypeParam> rows;
  if (TypeParam::kLimited) rows.limit = {7.0};
  rows.resizeRows(1);
  rows.D = {0.3};
  for (int k = 0; k < TypeParam::kBreakpoints; ++k)
    for (const bool stiff : {false, true}) {
      rows.placeAtBreakpoint(0, k, stiff);
      const TypeParam s = rows.penalty(0);
      EXPECT_EQ(s.at(rows.x[0]).curvature, stiff ? 0.3 : 0.0);
      EXPECT_LE(std::abs(rows.aboveBreakpoint(0, k)), 1e-15 * std::abs(s.breakpoint(k)) + 1e-300);
    }
}

TEST(HalfQuadratic, PullsOnOneSideOnly) {
  const HalfQuadratic s{3.0};
  EXPECT_EQ(s.at(-2.0).value, 6.0);
  EXPECT_EQ(-s.at(-2.0).slope, 6.0);  // force D·2 ≥ 0
  EXPECT_EQ(s.at(2.0).value, 0.0);
  EXPECT_EQ(s.at(2.0).slope, 0.0);
}

TEST(Huber, PullsToBothSidesAndNoMoreThanItsLimit) {
  const Huber s{3.0, 6.0};
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(s.at(sign).value, 1.5);
    EXPECT_EQ(-s.at(sign).slope, -3.0 * sign);
    EXPECT_EQ(-s.at(5.0 * sign).slope, -6.0 * sign);
    EXPECT_EQ(s.at(5.0 * sign).value, 6.0 * 4.0);
  }
}

TEST(Quadratic, PullsToBothSides) {
  EXPECT_EQ(Quadratic{3.0}.at(-2.0).value, 6.0);
  EXPECT_EQ(-Quadratic{3.0}.at(2.0).slope, -6.0);
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
  rows.advance(1.0);  // the second row crosses its breakpoint
  rows.evaluate(changed);
  EXPECT_TRUE(changed);
}

// From one free piece to the other: the curvature is the same, the cell is not.
TEST(Rows, EvaluateTellsThatAFrictionTurnedAround) {
  ScalarRows<Huber> rows;
  rows.limit = {1.0};
  rows.resizeRows(1);
  rows.D = {10.0};
  rows.x = {-3.0};
  bool changed = false;
  rows.evaluate(changed);
  rows.x = {3.0};
  changed = false;
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

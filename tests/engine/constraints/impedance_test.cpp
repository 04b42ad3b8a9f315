// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/contact_softness.hpp"
#include "softgauss/engine/constraints/law/row_law.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

TEST(Impedance, ClosedFormPoints) {
  const Impedance p;  // 0.9 → 0.95 over 1 mm, parabolas that meet in the middle
  EXPECT_SMALL(impedanceAt(p, 0.0) - 0.9, kUnitRounding);
  EXPECT_SMALL(impedanceAt(p, -0.25e-3) - (0.9 + 0.05 * 0.125), kUnitRounding);
  EXPECT_SMALL(impedanceAt(p, -0.5e-3) - 0.925, kUnitRounding);
  EXPECT_SMALL(impedanceAt(p, -0.75e-3) - (0.9 + 0.05 * 0.875), kUnitRounding);
  EXPECT_SMALL(impedanceAt(p, -1e-3) - 0.95, kUnitRounding);
  EXPECT_SMALL(impedanceAt(p, -1.0) - 0.95, kUnitRounding);
}

// Powers 1, 2 and 3 about other midpoints: y = xᵖ/mᵖ⁻¹ below m, mirrored above.
TEST(Impedance, FollowsThePowerCurve) {
  Impedance p;
  p.dMin = 0.2;
  p.dMax = 0.8;
  p.width = 2.0;
  p.midpoint = 0.3;
  for (const double power : {1.0, 2.0, 3.0, 2.5}) {
    p.power = power;
    const double low = std::pow(0.2, power) / std::pow(0.3, power - 1);
    const double high = 1 - std::pow(0.4, power) / std::pow(0.7, power - 1);
    EXPECT_SMALL(impedanceAt(p, -0.4) - (0.2 + 0.6 * low), kUnitRounding) << power;
    EXPECT_SMALL(impedanceAt(p, -1.2) - (0.2 + 0.6 * high), kUnitRounding) << power;
  }
}

TEST(Impedance, RisesMonotonicallyAndIsEven) {
  for (const double power : {1.0, 2.0, 3.5})
    for (const double midpoint : {0.1, 0.5, 0.9}) {
      Impedance p;
      p.power = power;
      p.midpoint = midpoint;
      double previous = 0.0;
      for (int i = 0; i <= 120; ++i) {
        const double d = impedanceAt(p, -1e-5 * i);
        EXPECT_GE(d, previous);
        EXPECT_GE(d, p.dMin);
        EXPECT_LE(d, p.dMax);
        EXPECT_EQ(d, impedanceAt(p, 1e-5 * i));
        previous = d;
      }
    }
}

TEST(Impedance, IsContinuousAtItsMidpoint) {
  Impedance p;
  p.midpoint = 0.3;
  for (const double power : {2.0, 3.0}) {
    p.power = power;
    EXPECT_SMALL(impedanceAt(p, 0.3e-3 * (1 - 1e-12)) - impedanceAt(p, 0.3e-3 * (1 + 1e-12)),
                 1e-12);
  }
}

TEST(Impedance, IsClampedAwayFromZeroAndOne) {
  Impedance p;
  p.dMin = 0.0;
  p.dMax = 1.0;
  EXPECT_EQ(impedanceAt(p, 0.0), 1e-4);
  EXPECT_EQ(impedanceAt(p, 1.0), 0.9999);
}

TEST(Impedance, WithoutWidthIsTheMean) {
  Impedance p;
  p.width = 0.0;
  EXPECT_SMALL(impedanceAt(p, -0.1) - 0.925, kUnitRounding);
  p.width = 0.001;
  p.dMax = p.dMin;
  EXPECT_EQ(impedanceAt(p, -0.1), 0.9);
}

TEST(Softness, IsTheReferenceSpringDamper) {
  Impedance p;
  p.timeConstant = 0.05;
  p.dampingRatio = 0.7;
  const double r = -0.5e-3, d = 0.925, A = 3.0;
  const Softness s = softnessAt(p, r, A, 0.002);
  EXPECT_SMALL(s.R - (1 - d) / d * A, kUnitRounding);
  EXPECT_SMALL(s.stiffness / (d / std::pow(0.95 * 0.05 * 0.7, 2)) - 1.0, kUnitRounding);
  EXPECT_SMALL(s.damping / (2 / (0.95 * 0.05)) - 1.0, kUnitRounding);
  EXPECT_EQ(s.referenceAcceleration(0.3, r), -s.damping * 0.3 - s.stiffness * r);
}

TEST(Softness, TimeConstantIsAtLeastTwoSteps) {
  Impedance fast, slow;
  fast.timeConstant = 0.003;
  slow.timeConstant = 0.02;
  const double h = 0.01;
  const Softness a = softnessAt(fast, -0.001, 1.0, h), b = softnessAt(slow, -0.001, 1.0, h);
  EXPECT_EQ(a.stiffness, b.stiffness);
  EXPECT_EQ(a.damping, b.damping);
}

// Given directly, deep inside the constraint the row is the spring-damper itself: d k = stiffness
// and d b = damping where d = dMax. The step is not asked.
TEST(Softness, OfADirectReferenceIsThatReferenceWhereDeep) {
  Impedance p;
  p.direct = {3000.0, 40.0};
  for (const double timestep : {1e-4, 0.1}) {
    const Softness deep = softnessAt(p, -1.0, 3.0, timestep);
    EXPECT_SMALL(0.95 * deep.stiffness / 3000.0 - 1.0, kUnitRounding);
    EXPECT_SMALL(0.95 * deep.damping / 40.0 - 1.0, kUnitRounding);
    const Softness shallow = softnessAt(p, 0.0, 3.0, timestep);
    EXPECT_SMALL(shallow.stiffness / deep.stiffness - 0.9 / 0.95, kUnitRounding);
    EXPECT_EQ(shallow.damping, deep.damping);
    EXPECT_EQ(shallow.R, softnessAt(Impedance{}, 0.0, 3.0, timestep).R);
  }
}

Options leapfrogOf(double h) {
  Options options;
  options.timestep = h;
  return options;
}

/// The row of A = 1 that the leapfrog takes.
Softness taken(const Impedance& p, double r, const Options& options) {
  const auto bounces = bouncingSoftness(p, 1.0, options);
  return bounces ? *bounces : rowLaw(p, r, 1.0, options);
}

/// The largest speed with which a row whose reference is `p` returns what comes with 1 m/s, over
/// the places in the step in which it may arrive.
double fastestReturn(const Impedance& p, double h) {
  const Options options = leapfrogOf(h);
  double fastest = 0.0;
  for (int i = 0; i < 50; ++i) {
    double v = -1.0, r = -h * (i + 0.5) / 50;  // r at mid-step
    for (int n = 0; n < 2000 && r < 0.0; ++n) {
      const Softness s = taken(p, r, options);
      v += h * std::max(0.0, s.referenceAcceleration(v, r)) / (1.0 + s.R);
      r += h * v;
    }
    if (r >= 0.0) fastest = std::max(fastest, v);
  }
  return fastest;
}

// Rows (3.14) give back no more than came, over both forms of a reference, however stiff.
TEST(Softness, AStepReturnsNothingFasterThanItCame) {
  const double h = 0.002;
  Impedance p;
  p.dMin = p.dMax = 0.9999;
  for (double timeConstant = h; timeConstant < 1e4 * h; timeConstant *= 1.7)
    for (double ratio = 1e-4; ratio < 4.0; ratio *= 1.7) {
      p.timeConstant = timeConstant, p.dampingRatio = ratio;
      EXPECT_LE(fastestReturn(p, h), 1.0) << timeConstant / h << " " << ratio;
    }
  for (double K = 1e-4; K < 1e3; K *= 1.7)
    for (double B = 1e-6; B < 1e3; B *= 1.7) {
      p.direct = ReferenceSpring{K / (h * h), B / h};
      EXPECT_LE(fastestReturn(p, h), 1.0) << K << " " << B;
    }
}

// However much more than its own A the row moves, x̂ = A′/(A′ + R) a_ref, no motion grows.
TEST(Softness, IsStableWhateverItMoves) {
  const double h = 0.002;
  for (const double d : {1e-4, 0.01, 0.1, 0.5, 0.95})
    for (const double timeConstant : {0.004, 0.02, 0.1})
      for (double more = 1.0; more < 1e9; more *= 3.0) {
        Impedance p;
        p.dMin = p.dMax = d;
        p.timeConstant = timeConstant;
        const Softness s = rowLaw(p, -1.0, 3.0, leapfrogOf(h));
        const double moves = 3.0 * more / (3.0 * more + s.R);
        // λ² − (1 + α − κ) λ + α of r⁺ = r + h v⁺, v⁺ = α v − κ r/h has both |λ| ≤ 1.
        const double alpha = 1.0 - h * moves * s.damping, kappa = h * h * moves * s.stiffness;
        EXPECT_GE(alpha, -kUnitRounding);
        EXPECT_LE(alpha, 1.0);
        EXPECT_LE(kappa, 2.0 * (1.0 + alpha));
      }
}

// The two forms agree: 1/(tc ζ)² and 2/tc.
TEST(Softness, OfADirectReferenceIsThatOfItsTimeConstant) {
  Impedance standard, direct;
  standard.timeConstant = 0.03;
  standard.dampingRatio = 0.6;
  direct.direct = {1.0 / std::pow(0.03 * 0.6, 2), 2.0 / 0.03};
  for (const double r : {0.0, -0.3e-3, -0.1}) {
    const Softness a = softnessAt(standard, r, 2.0, 0.002), b = softnessAt(direct, r, 2.0, 0.002);
    EXPECT_SMALL(a.stiffness / b.stiffness - 1.0, kUnitRounding);
    EXPECT_SMALL(a.damping / b.damping - 1.0, kUnitRounding);
  }
}

// One that is given directly wins; of two, each number is the larger. Either way round.
TEST(Softness, DirectReferencesMix) {
  Impedance standard, soft, stiff;
  soft.direct = {2000.0, 30.0};
  stiff.direct = {4000.0, 20.0};
  EXPECT_FALSE(mixImpedances(standard, standard).direct);
  for (const bool swapped : {false, true}) {
    const auto mix = [&](const Impedance& p, const Impedance& q) {
      return swapped ? mixImpedances(q, p) : mixImpedances(p, q);
    };
    EXPECT_EQ(mix(standard, soft).direct, soft.direct);
    EXPECT_EQ(mix(soft, stiff).direct, (ReferenceSpring{4000.0, 30.0}));
  }
}

TEST(Softness, RegulariserHasAFloor) {
  EXPECT_EQ(softnessAt(Impedance{}, -0.001, 0.0, 0.002).R, 1e-15);
}

}  // namespace
}  // namespace softgauss::test

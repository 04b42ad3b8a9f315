// SPDX-License-Identifier: Apache-2.0
/// The box on the controls: conditions of Karush, Kuhn and Tucker, checked without the solver.
///
/// Where no row sits at its breakpoint, F is smooth and a minimum within lower ≤ g ≤ upper has
///   P (M⁻¹ g + μ) + ∇ℓ = 0,  μ_i ≥ 0 at upper, ≤ 0 at lower, = 0 between.
/// So μ follows from a alone.

#include <Eigen/Cholesky>

#include "tests/gdd/gdd_scene.hpp"
#include "tests/gdd/goal_check.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

struct Conditions {
  double wrongSign = 0.0;  ///< largest multiplier that pushes the wrong way, relative
  double violation = 0.0;  ///< of the box, relative
  int atBound = 0;
};

/// Multipliers relative to the terms of which they are the difference.
Conditions conditionsAt(const DenseGdd& d, const VectorX& a) {
  const VectorX g = d.g(a);
  const Eigen::LLT<MatrixX> P(d.P(a));
  const VectorX effort = d.Minv * g, wish = P.solve(d.goalGradient(a));
  const VectorX mu = -(effort + wish);
  Conditions result;
  const double force = std::max(1.0, d.c.cwiseAbs().maxCoeff());
  const double scale = std::max(effort.cwiseAbs().maxCoeff(), wish.cwiseAbs().maxCoeff());
  for (int i = 0; i < d.dofs(); ++i) {
    result.violation =
        std::max({result.violation, (d.lower[i] - g[i]) / force, (g[i] - d.upper[i]) / force});
    if (d.lower[i] == d.upper[i]) continue;  // an equality: any multiplier
    const bool atLower = g[i] < d.lower[i] + 1e-7 * force;
    const bool atUpper = g[i] > d.upper[i] - 1e-7 * force;
    result.atBound += atLower || atUpper;
    double wrong = std::abs(mu[i]);
    if (atUpper) wrong = -mu[i];
    if (atLower) wrong = mu[i];
    result.wrongSign = std::max(result.wrongSign, wrong / scale);
  }
  return result;
}

// Without rows the problem is convex: these conditions are enough for the global minimum.
TEST(Box, SaturatedActuatorsSatisfyTheirConditions) {
  double worstSign = 0.0, worstViolation = 0.0;
  int atBound = 0, scenes = 0;
  for (int seed = 0; seed < 100; ++seed) {
    RandomTreeOptions options;
    options.ranges = options.geometries = false;
    GddScene s = randomGddScene(seed, 0, 0.8, options);
    ASSERT_EQ(s.dense.rows(), 0);
    const VectorX& a = s.solve();
    EXPECT_EQ(s.report.status, gdd::GddStatus::converged) << "seed " << seed;
    const Conditions at = conditionsAt(s.dense, a);
    worstSign = std::max(worstSign, at.wrongSign);
    worstViolation = std::max(worstViolation, at.violation);
    atBound += at.atBound;
    scenes += at.atBound > 0;
  }
  // ∇Φ within 1e-8, times P⁻¹, whose largest entry is some 1e3 of its smallest.
  EXPECT_SMALL(worstSign, 1e-6);
  // Asked for is 1e-10; 1e-8 is accepted where rounding ends the progress.
  EXPECT_SMALL(worstViolation, 1e-8);
  EXPECT_GT(scenes, 80) << "the boxes are to be at work";
  EXPECT_GT(atBound, 200);
}

// Multipliers of the start that are too large hold forces inside the box, off bounds that they
// should be at: within the box is not enough. An arm without unactuated dofs, whose forces would
// show it.
TEST(Box, ConditionsHoldWhereASolveStartsFromLargeMultipliers) {
  double worstSign = 0.0;
  int atBound = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed + 5);
    GddScene s(drivenArm(seed));
    s.addRandomGoals(random);
    s.addRandomBox(random, 0.8);
    s.solve();
    WarmStart& warm = s.scene.state.warmstart;
    s.solver->keepWarmStart(warm);
    warm.multipliers *= random.uniform(1.5, 3.0);
    const VectorX& a = s.solve();
    EXPECT_EQ(s.report.status, gdd::GddStatus::converged) << "seed " << seed;
    const Conditions at = conditionsAt(s.dense, a);
    worstSign = std::max(worstSign, at.wrongSign);
    atBound += at.atBound;
  }
  EXPECT_SMALL(worstSign, 1e-6);
  EXPECT_GT(atBound, 100);
}

TEST(Box, ConditionsHoldBetweenContactsAndLimits) {
  double worstSign = 0.0, worstViolation = 0.0;
  int atBound = 0, smooth = 0, kinks = 0;
  for (int seed = 0; seed < 150; ++seed) {
    GddScene s = lawGddScene(seed, 4, 0.8);
    const VectorX& a = s.solve();
    kinks += s.report.status == gdd::GddStatus::nonsmoothMinimum;
    if (s.report.status != gdd::GddStatus::converged) continue;
    ++smooth;
    const Conditions at = conditionsAt(s.dense, a);
    worstSign = std::max(worstSign, at.wrongSign);
    worstViolation = std::max(worstViolation, at.violation);
    atBound += at.atBound;
  }
  EXPECT_SMALL(worstSign, 1e-6);
  EXPECT_SMALL(worstViolation, 1e-8);
  EXPECT_GT(smooth, 30);
  EXPECT_GT(smooth + kinks, 120) << "most solves are to end with a certificate";
  EXPECT_GT(atBound, 50);
}

TEST(Box, OneWithoutWidthIsAnEquality) {
  for (int seed = 0; seed < 20; ++seed) {
    GddScene s = randomGddScene(seed, 0, 0.0);
    Random random(seed);
    for (int i = 0; i < s.dofs(); ++i)
      if (s.model().dofs[i].actuated && random.chance(0.3))
        s.limits.lower[i] = s.limits.upper[i] = random.uniform(-5.0, 5.0);
    const VectorX& a = s.solve();
    EXPECT_LE(s.dense.violation(a), 1e-8 * std::max(1.0, s.dense.c.cwiseAbs().maxCoeff()));
  }
}

}  // namespace
}  // namespace softgauss::test

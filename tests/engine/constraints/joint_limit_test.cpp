// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/joint_limit.hpp"

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// A pendulum with the range [−0.5, 0.7] at q with speed v, rows made.
Scene limited(double q, double v, double margin = 0.0) {
  Model model = pendulum(0.5, 1.0, 0.05).build();
  JointRange range;
  range.body = 1;
  range.lower = -0.5;
  range.upper = 0.7;
  range.margin = margin;
  model.ranges.push_back(range);
  Scene s(std::move(model));
  s.state.q[0] = q;
  s.state.v[0] = v;
  s.stages();
  return s;
}

TEST(JointLimit, MakesARowOnlyBeyondItsEnds) {
  for (const double inside : {-0.5, -0.2, 0.0, 0.7})
    EXPECT_EQ(limited(inside, 0.0).data->stats.rows, 0) << inside;
  for (const double outside : {-0.501, 0.701})
    EXPECT_EQ(limited(outside, 0.0).data->stats.rows, 1) << outside;
}

// (3.16): what gets there within the step of 2 ms meets a row that ends the step at the end of the
// range, but for 1/(1 + κ).
TEST(JointLimit, BeginsWithinTheStepThatWouldPassIt) {
  EXPECT_EQ(limited(0.699, 1.0).data->stats.rows, 1);
  EXPECT_EQ(limited(0.697, 1.0).data->stats.rows, 0);
  EXPECT_EQ(limited(0.699, -1.0).data->stats.rows, 0);
  EXPECT_EQ(limited(-0.499, -1.0).data->stats.rows, 1);
  Scene s = limited(0.699, 1.0);
  s.model.options.gravity.setZero();
  s.stages();
  s.forward();
  const double left = 0.7 - 0.699 - 0.002 - 0.002 * 0.002 * s.data->forward.a[0];
  EXPECT_SMALL(left / -0.001 - 1.0 / 31.0, 1e-9);
}

TEST(JointLimit, PushesInward) {
  for (const double sign : {-1.0, 1.0}) {
    Scene s = limited(sign > 0 ? 0.7004 : -0.5004, 0.3 * sign);
    const JointLimit& rows = s.data->constraints.jointLimit;
    EXPECT_EQ(rows.sign(0), -sign);
    EXPECT_EQ(rows.dof(0), 0);
    // D = κ/A, and the depth goes with the time constant τ = 2 t_c after the half step t.
    const double h = 0.002, reference = 0.3 / h + 0.0004 / (h * (0.5 * h + 2.0 * 0.02));
    EXPECT_SMALL(rows.D[0] * s.data->weights.dof[0] / 30.0 - 1.0, 1e-11);
    // The distance is a difference: 1e-16 of 0.7 in 0.0004.
    EXPECT_SMALL(rows.reference[0] / reference - 1.0, 1e-10);
    s.forward();
    EXPECT_GT(rows.f[0], 0.0);
    VectorX force = VectorX::Zero(1);
    rows.addTransposed(rows.f, force);
    EXPECT_EQ(force[0], -sign * rows.f[0]);
  }
}

TEST(JointLimit, DistanceCountsFromTheMargin) {
  EXPECT_EQ(limited(0.69, 0.0, 0.02).data->stats.rows, 1);
  EXPECT_EQ(limited(0.67, 0.0, 0.02).data->stats.rows, 0);
  const Scene a = limited(0.7004, 0.2), b = limited(0.6804, 0.2, 0.02);
  EXPECT_SMALL(
      a.data->constraints.jointLimit.reference[0] / b.data->constraints.jointLimit.reference[0] -
          1.0,
      1e-11);
}

TEST(JointLimit, OfBothEndsWhenTheRangeIsAPoint) {
  Model model = pendulum(0.5, 1.0, 0.05).build();
  JointRange range;
  range.body = 1;
  range.lower = range.upper = 0.1;
  range.margin = 0.001;
  model.ranges.push_back(range);
  Scene s(std::move(model));
  s.state.q[0] = 0.1;
  s.stages();
  ASSERT_EQ(s.data->stats.rows, 2);
  EXPECT_EQ(s.data->constraints.jointLimit.sign(0), 1.0);  // lower first
  EXPECT_EQ(s.data->constraints.jointLimit.sign(1), -1.0);
}

}  // namespace
}  // namespace softgauss::test

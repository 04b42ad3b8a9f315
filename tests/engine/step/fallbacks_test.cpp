// SPDX-License-Identifier: Apache-2.0
/// What a step does in place of what it was asked for is counted, and only then.

#include <gtest/gtest.h>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

Model sphere(const Options& options) {
  ModelBuilder builder = sphereOnPlane(0.1, 1.0, 0.5);
  builder.options = options;
  return builder.build();
}

/// A sphere that slides and rolls on the ground, with friction that has to be found by iterations.
struct Sliding : Scene {
  explicit Sliding(const Options& options = {}) : Scene(sphere(options)) {
    contacts = std::make_shared<collision::SceneContacts>(model);
    state.q[2] = 0.0999;
    state.v[0] = 1.0;
  }
};

void expectNone(const StepStats& stats) {
  EXPECT_EQ(stats.unconvergedSolves, 0);
  EXPECT_EQ(stats.roundingLimitedSolves, 0);
  EXPECT_EQ(stats.invalidWarmStarts, 0);
  EXPECT_EQ(stats.abandonedTrees, 0);
  EXPECT_EQ(stats.minimumStepsAccepted, 0);
}

TEST(Fallbacks, AreNoneInAPlainStep) {
  Sliding s;
  int rows = 0;
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(s.step(), SolveStatus::converged);
    rows += s.data->stats.rows;
    expectNone(s.data->stats);
  }
  EXPECT_GT(rows, 0);
}

TEST(Fallbacks, ASolveThatEndsShortIsCountedWithItsResidual) {
  Options options;
  options.maxIterations = 1;
  options.mechanisms.remove(Mechanism::midpointVelocity);  // a second solve would go on from it
  options.mechanisms.remove(Mechanism::slipCorrection);    // with it one iteration is enough
  Sliding s(options);
  EXPECT_EQ(s.step(), SolveStatus::iterationLimit);
  EXPECT_EQ(s.data->stats.unconvergedSolves, 1);
  EXPECT_GT(s.data->stats.residual, options.tolerance);
  // The gradient itself, scaled: what it says is what is left.
  EXPECT_SMALL(
      s.data->stats.residual -
          s.data->forward.gradient.cwiseProduct(s.data->forward.scale).cwiseAbs().maxCoeff(),
      1e-12 * s.data->stats.residual);
}

TEST(Fallbacks, ASolveThatRoundingEndsIsCounted) {
  Options options;
  options.tolerance = 1e-17;
  Sliding s(options);
  int rounded = 0;
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(s.step(), SolveStatus::converged);
    rounded += s.data->stats.roundingLimitedSolves;
    EXPECT_LE(s.data->stats.residual, 1e3 * options.tolerance);
    EXPECT_EQ(s.data->stats.roundingLimitedSolves > 0, s.data->stats.residual > options.tolerance);
  }
  EXPECT_GT(rounded, 0);
}

TEST(Fallbacks, AGuessThatIsNotFiniteIsCounted) {
  Sliding s;
  s.steps(2);
  s.state.warmstart.a[3] = std::numeric_limits<double>::quiet_NaN();
  ASSERT_EQ(s.step(), SolveStatus::converged);
  EXPECT_EQ(s.data->stats.invalidWarmStarts, 1);
  ASSERT_EQ(s.step(), SolveStatus::converged);
  expectNone(s.data->stats);
}

// A ball that lands with 10 m/s: where the force jumps no part of a step is short enough for a
// tolerance of 10⁻¹⁵ m.
TEST(Fallbacks, PartsThatAreTakenInSpiteOfTheirEstimateAreCounted) {
  for (const bool doubling : {false, true}) {
    Options options;
    options.integrator = doubling ? Integrator::semiImplicitEuler : Integrator::dormandPrince;
    options.stepDoubling = doubling;
    options.integrationTolerance = 1e-15;
    Sliding s(options);
    s.state.q[2] = 0.13;
    s.state.v[2] = -10.0;
    int jumps = 0, rejections = 0;
    for (int i = 0; i < 20; ++i) {
      ASSERT_FALSE(isRefused(s.step()));
      jumps += s.data->stats.minimumStepsAccepted;
      rejections += s.data->stats.rejections;
    }
    EXPECT_GT(jumps, 0) << doubling;
    EXPECT_GT(rejections, 0);
  }
}

// A hinge that meets the end of its range at 100 rad/s and more: the sweeps of the midpoint rule do
// not close on a force that jumps, unless the middle of a part happens to lie well.
TEST(Fallbacks, SweepsThatDoNotCloseAreCounted) {
  ModelBuilder builder = pendulum(0.5, 1.0, 0.05);
  JointSpec& hinge = *builder.findJoint("hinge");
  hinge.type = JointType::revolute;
  hinge.lower = -1.0, hinge.upper = 1.0;
  builder.options.timestep = 0.02;
  builder.options.integrator = Integrator::implicitMidpoint;
  int jumps = 0;
  for (const double speed : {100.0, 150.0, 200.0, 300.0, 400.0}) {
    Scene s(builder.build());
    s.state.v[0] = speed;
    for (int i = 0; i < 150; ++i) {
      ASSERT_FALSE(isRefused(s.step()));
      jumps += s.data->stats.minimumStepsAccepted;
    }
  }
  EXPECT_GE(jumps, 2);
}

}  // namespace
}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/step_doubling.hpp"

#include <cmath>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

struct Ran {
  State state;
  int rejections = 0, substeps = 0, evaluations = 0, jumps = 0;
};

Ran run(ModelBuilder builder, double h, int steps, const VectorX& q, const VectorX& v,
        bool contacts = false) {
  builder.options.timestep = h;
  const Model model = builder.build();
  collision::SceneContacts source(model);
  Data data(model);
  Ran ran;
  ran.state = State(model);
  ran.state.q = q;
  ran.state.v = v;
  for (int i = 0; i < steps; ++i) {
    EXPECT_FALSE(isRefused(step(model, {}, ran.state, data, contacts ? &source : nullptr)));
    ran.rejections += data.stats.rejections;
    ran.substeps += data.stats.substeps;
    ran.evaluations += data.stats.evaluations;
    ran.jumps += data.stats.minimumStepsAccepted;
  }
  return ran;
}

// Within tolerance nothing is divided: what is kept are two steps of half the length, bit for bit
// but for the sum of the times.
TEST(StepDoubling, KeepsTheTwoHalves) {
  for (const Integrator integrator : {Integrator::semiImplicitEuler, Integrator::implicit}) {
    ModelBuilder builder = chain(3);
    builder.options.integrator = integrator;
    builder.options.integrationTolerance = 1e3;
    const VectorX q = VectorX::Constant(3, 0.4), v = VectorX::Constant(3, 0.5);
    const Ran halves = run(builder, 0.001, 20, q, v);
    builder.options.stepDoubling = true;
    const Ran doubled = run(builder, 0.002, 10, q, v);
    EXPECT_EQ(doubled.rejections, 0);
    EXPECT_EQ(doubled.evaluations, 30);
    EXPECT_EQ((doubled.state.q - halves.state.q).norm(), 0.0);
    EXPECT_EQ((doubled.state.v - halves.state.v).norm(), 0.0);
  }
}

// Errors of the parts add up: at most the tolerance a step, spread by a pendulum that swings up.
TEST(StepDoubling, KeepsItsTolerance) {
  ModelBuilder builder = pendulum(0.5, 1.0, 0.05);
  const VectorX q = VectorX::Constant(1, 1.0), v = VectorX::Constant(1, 0.0);
  builder.options.integrator = Integrator::rungeKutta4;
  const Ran exact = run(builder, 0.0005, 640, q, v);
  builder.options.integrator = Integrator::semiImplicitEuler;
  builder.options.stepDoubling = true;
  int before = 0;
  double last = 1.0;
  for (const double tolerance : {1e-4, 1e-5, 1e-6}) {
    builder.options.integrationTolerance = tolerance;
    const Ran ran = run(builder, 0.016, 20, q, v);
    const double error = std::abs(ran.state.q[0] - exact.state.q[0]);
    EXPECT_LT(error, 20 * 3.0 * tolerance);
    EXPECT_LT(error, last);
    EXPECT_GT(ran.rejections, 0);
    EXPECT_GT(ran.substeps, before);
    before = ran.substeps;
    last = error;
  }
}

// Touch-down is where it shortens: in free fall and at rest a step is two halves.
TEST(StepDoubling, ShortensWhereContactBegins) {
  ModelBuilder builder = sphereOnPlane(0.1, 1.0, 0.5);
  builder.options.stepDoubling = true;
  builder.options.integrationTolerance = 1e-4;
  VectorX q(7);
  q << 0, 0, 0.2, 1, 0, 0, 0;
  const VectorX v = VectorX::Zero(6);
  const Ran fall = run(builder, 0.004, 30, q, v, true);  // 0.12 s, touch-down is at 0.143 s
  EXPECT_EQ(fall.rejections, 0);
  const Ran landing = run(builder, 0.004, 250, q, v, true);
  EXPECT_GT(landing.rejections, 0);
  EXPECT_GT(landing.substeps, 250);
  EXPECT_NEAR(landing.state.q[2], 0.1, 0.001);
}

// What no part satisfies is taken by the shortest parts, whose last one rounding may make longer: a
// step ends, at any length.
TEST(StepDoubling, EndsWhateverIsAskedOfIt) {
  for (const double h : {0.001, 0.005, 0.01, 1.0 / 126.0, 0.02 / 63.0}) {
    ModelBuilder builder = chain(2);
    builder.options.timestep = h;
    builder.options.integrationTolerance = 1e-30;
    for (const bool doubling : {true, false}) {
      builder.options.stepDoubling = doubling;
      builder.options.integrator =
          doubling ? Integrator::semiImplicitEuler : Integrator::dormandPrince;
      const Model model = builder.build();
      Data data(model);
      State state(model);
      state.q.setConstant(0.4);
      for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(step(model, {}, state, data, nullptr), SolveStatus::converged);
        EXPECT_NEAR(data.stats.substeps, 512, 1) << h;  // of the shortest length
        EXPECT_NEAR(data.stats.minimumStepsAccepted, 512, 1) << h;
      }
    }
  }
}

// The step's own solve is finite, 1e200; those of its halves are not.
TEST(StepDoubling, LeavesTheStateWhereItOverflows) {
  ModelBuilder builder = chain(3);
  builder.options.stepDoubling = true;
  const Model model = builder.build();
  Data data(model);
  State state(model);
  state.q.setConstant(0.4);
  state.v[1] = 1e100;
  const std::uint64_t before = hash(state);
  EXPECT_EQ(step(model, {}, state, data, nullptr), SolveStatus::notFinite);
  EXPECT_EQ(hash(state), before);
}

// What a part that is shortened went through has not happened: the deepest overlap is that of the
// way that was taken, by all that divide steps. A ball that meets the ground at 10 m/s would be 60
// mm deep after 8 ms of free fall; stages do not meet the deepest place itself.
TEST(ErrorControl, TellsNoOverlapOfPartsThatWereShortened) {
  struct Method {
    Integrator integrator;
    bool doubling;
  };
  for (const Method method :
       {Method{Integrator::dormandPrince, false}, Method{Integrator::semiImplicitEuler, true},
        Method{Integrator::implicitMidpoint, false}}) {
    ModelBuilder builder = sphereOnPlane(0.1, 1.0, 0.5);
    builder.options.integrator = method.integrator;
    builder.options.stepDoubling = method.doubling;
    builder.options.timestep = 0.008;
    const Model model = builder.build();
    collision::SceneContacts source(model);
    Data data(model);
    State state(model);
    state.q[2] = 0.12;
    state.v[2] = -10.0;
    int rejections = 0;
    ASSERT_FALSE(isRefused(step(model, {}, state, data, &source)));
    rejections += data.stats.rejections;
    EXPECT_GT(rejections, 0);
    // The same step in 64 pieces sees how deep the ball comes to be.
    ModelBuilder fine = builder;
    fine.options.timestep = 0.008 / 64;
    const Model pieces = fine.build();
    collision::SceneContacts again(pieces);
    Data one(pieces);
    State other(pieces);
    other.q[2] = 0.12;
    other.v[2] = -10.0;
    double deepest = 0.0;
    for (int i = 0; i < 64; ++i) {
      ASSERT_FALSE(isRefused(step(pieces, {}, other, one, &again)));
      deepest = std::max(deepest, 0.1 - other.q[2]);
    }
    EXPECT_GT(data.stats.maxPenetration, 0.8 * deepest);
    EXPECT_LT(data.stats.maxPenetration, 1.1 * deepest) << static_cast<int>(method.integrator);
  }
}

}  // namespace
}  // namespace softgauss::test

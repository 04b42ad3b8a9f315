// SPDX-License-Identifier: Apache-2.0
/// What a study looks at after every step, not only where motions are compared.

#include "apps/accuracy_cost/study.hpp"

#include <algorithm>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

/// A slide of 1 kg that runs against the end of its range at 1 m/s and is back before the first
/// period of 32 ms is over.
app::Problem stop() {
  app::Problem p;
  p.name = "stop";
  p.periods = p.windowPeriods = 2;
  p.build = [] {
    ModelBuilder builder("stop");
    builder.options.effects.remove(Effect::gravity);
    LinkSpec world;
    world.name = "world";
    builder.link(world).link(app::boxLink("mass", 1.0, {0.1, 0.1, 0.1}));
    JointSpec slide = app::joint("slide", JointType::prismatic, "world", "mass", Vector3::UnitX(),
                                 Vector3::Zero());
    slide.lower = -1.0, slide.upper = 0.005;
    slide.stiffness = 1e4;
    builder.joint(slide);
    return builder;
  };
  p.start = [](const Model&, State& state) { state.v[0] = 1.0; };
  return p;
}

TEST(Study, SeesOvershootBetweenPeriods) {
  constexpr double kStep = 0.001;
  const app::Problem problem = stop();
  const app::Method euler{"softgauss", "semi-implicit-euler", ""};
  const auto tested = app::makeEngine(problem, euler, kStep);
  State start(tested->model());
  problem.start(tested->model(), start);
  tested->start(start);
  double most = 0.0, sampled = 0.0;
  for (int i = 1; i <= 64; ++i) {
    ASSERT_TRUE(tested->advance(VectorX::Zero(1), 1));
    const double over = tested->state().q[0] - 0.005;
    most = std::max(most, over);
    if (i % 32 == 0) sampled = std::max(sampled, over);
  }
  ASSERT_GT(most, 1.1 * sampled);
  app::Study study(problem, {});
  ASSERT_TRUE(study.prepare(euler));
  EXPECT_EQ(study.measure(euler, kStep).overshoot, most);
}

// What is known in closed form is the motion: an integrator of order 4 at 1/8 ms agrees, in places
// and in velocities. It errs by 1e-11 there, most of it in the top.
TEST(Study, ClosedFormsAreTheMotion) {
  int checked = 0;
  for (const app::Problem& problem : app::allProblems(dataFile("robots"))) {
    if (!problem.exact) continue;
    const app::Method rk4{"softgauss", "runge-kutta-4", ""};
    const auto tested = app::makeEngine(problem, rk4, app::kPeriod / 256);
    const Model& model = tested->model();
    State start(model);
    problem.start(model, start);
    tested->start(start);
    app::LinkPoses a(model), b(model);
    for (int k = 1; k <= 62; ++k) {
      ASSERT_TRUE(tested->advance(VectorX::Zero(model.nv), 256));
      State exact(model);
      problem.exact(model, k * app::kPeriod, exact);
      a.set(exact);
      b.set(tested->state());
      ASSERT_LT(a.against(b).total, 1e-11) << problem.name << " at period " << k;
      ASSERT_LT((exact.v - tested->state().v).norm(), 1e-9 * start.v.norm() + 1e-9)
          << problem.name << " at period " << k;
    }
    ++checked;
  }
  EXPECT_EQ(checked, 4);
}

// A ball that falls from 0.2 m is stopped within some centimetres, by either engine alike: their
// contacts are of one softness, but ours know the load that they carry.
TEST(Study, SeesTheDeepestOverlapInBothEngines) {
  const std::vector<app::Problem> problems = app::allProblems(dataFile("robots"));
  const app::Problem& ball = *std::find_if(problems.begin(), problems.end(),
                                           [](const auto& p) { return p.name == "bouncing_ball"; });
  std::vector<app::Method> methods{{"softgauss", "semi-implicit-euler", ""}};
  if (!app::mujocoMethods(ball).empty()) methods.push_back({"mujoco", "Euler", ""});
  double deepest[2] = {};
  for (std::size_t k = 0; k < methods.size(); ++k) {
    const auto tested = app::makeEngine(ball, methods[k], 0.001);
    tested->start(State(tested->model()));
    double lowest = 1.0;
    for (int i = 0; i < 300; ++i) {
      const double height = tested->state().q[2];
      ASSERT_TRUE(tested->advance({}, 1));
      deepest[k] = std::max(deepest[k], tested->deepestOverlap());
      lowest = std::min(lowest, height);
      // Of the step: where it began, the ball of 0.1 m was so deep in the plane.
      EXPECT_NEAR(tested->deepestOverlap(), std::max(0.0, 0.1 - height), 1e-12) << i;
    }
    EXPECT_GT(deepest[k], 0.001);
    EXPECT_LT(lowest, 0.1);
  }
  if (methods.size() > 1) {
    EXPECT_NEAR(deepest[1] / deepest[0], 1.0, 0.5);
  }
}

}  // namespace
}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0
/// The engines that accuracy_cost compares.

#include "apps/accuracy_cost/engine_under_test.hpp"

#include <algorithm>
#include <cstdint>

#include "apps/shared/pose_error.hpp"
#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

app::Problem problemOf(const std::string& name) {
  const std::vector<app::Problem> problems = app::allProblems(dataFile("robots"));
  return *std::find_if(problems.begin(), problems.end(),
                       [&](const app::Problem& p) { return p.name == name; });
}

// A window begins with what its state says, whatever was simulated before: the acceleration by
// which the last step ended is forgotten.
TEST(EngineUnderTest, WindowsBeginAfresh) {
  const app::Problem top = problemOf("spinning_top");
  const app::Method euler{"softgauss", "leapfrog", ""};
  const auto used = app::makeEngine(top, euler, app::kPeriod);
  const auto fresh = app::makeEngine(top, euler, app::kPeriod);
  State fast(used->model());
  top.start(used->model(), fast);
  used->start(fast);
  ASSERT_TRUE(used->advance({}, 4));
  ASSERT_TRUE(used->state().hasAcceleration);
  const State rest(used->model());
  used->start(rest);
  fresh->start(rest);
  ASSERT_TRUE(used->advance({}, 4));
  ASSERT_TRUE(fresh->advance({}, 4));
  EXPECT_EQ(used->state().q, fresh->state().q);
  EXPECT_EQ(used->state().v, fresh->state().v);
}

// With an averaged rate of turning, as under --compatibility mujoco, runge-kutta-4 is MuJoCo's:
// what is left is rounding. Without it the two differ wherever something turns freely.
TEST(EngineUnderTest, RungeKutta4LikeMujocoIsMujocos) {
  const app::Method theirs{"mujoco", "RK4", ""};
  if (app::mujocoMethods({}).empty()) GTEST_SKIP() << "MuJoCo was not found";
  constexpr double kStep = 0.004;
  for (const char* name : {"free_body", "humanoid_in_the_air"}) {
    const app::Problem problem = problemOf(name);
    const auto mujoco = app::makeEngine(problem, theirs, kStep);
    for (const bool likeMujoco : {true, false}) {
      ModelBuilder builder = problem.build();
      builder.options.timestep = kStep;
      builder.options.integrator = Integrator::rungeKutta4;
      builder.options.constraintModel =
          !likeMujoco ? ConstraintModel::softgauss : ConstraintModel::mujoco;
      const Model model = builder.build();
      Data data(model);
      State state(model);
      if (problem.start) problem.start(model, state);
      mujoco->start(state);
      ASSERT_TRUE(mujoco->advance({}, 250));
      for (int i = 0; i < 250; ++i) step(model, {}, state, data, nullptr);
      app::LinkPoses a(model), b(model);
      a.set(state);
      b.set(mujoco->state());
      if (likeMujoco)
        EXPECT_LT(a.against(b).total, 1e-13) << name;  // [m] after 1 s
      else
        EXPECT_GT(a.against(b).total, 1e-9) << name;
    }
  }
}

}  // namespace
}  // namespace softgauss::test

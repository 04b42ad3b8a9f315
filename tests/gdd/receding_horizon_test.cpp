// SPDX-License-Identifier: Apache-2.0
/// Plans that are acted out by goal directed dynamics in the simulator, whose steps are finer than
/// the plan's and have all mechanisms.

#include "softgauss/gdd/planning/receding_horizon.hpp"

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/io/plan_task.hpp"
#include "softgauss/io/simulation/scene.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

using namespace planning;

/// A task of data/plans in the simulator.
struct ActedTask {
  explicit ActedTask(const std::string& name, double step = 0.005)
      : file(std::string(SOFTGAUSS_SOURCE_DIR) + "/data/plans/" + name + ".yaml"),
        scene(loadScene(file)),
        task(io::readPlanTask(file, scene->model, scene->initial)),
        planner(scene->model, task.steps, [](const Model& model) {
          return std::make_unique<collision::SceneContacts>(model);
        }) {
    task.setCosts(planner);
    scene->model.options.timestep = step;
  }
  /// On contacts that begin 5 mm apart, or on those of the scene.
  void plan(bool gently) {
    if (gently && task.contacts) {
      task.endsOnOwnContacts = false;
      task.contacts->contacts.margin = 0.005;
    }
    task.solve(planner, scene->initial);
  }
  /// The state after `seconds`.
  State act(const HorizonOptions& options, double seconds) {
    const Model& model = scene->model;
    RecedingHorizon horizon(planner, options);
    gdd::GoalDirectedController controller(model);
    horizon.attach(controller);
    State state = scene->initial;
    EXPECT_TRUE(horizon.begin(state));
    Data data(model);
    collision::SceneContacts contacts(model);
    while (state.time < seconds - 1e-9) {
      horizon.update(state);
      const SolveStatus status = controller.step(model, {}, state, data, &contacts);
      EXPECT_FALSE(isRefused(status));
      if (isRefused(status)) break;
    }
    report = horizon.report();
    return state;
  }

  std::string file;
  std::unique_ptr<softgauss::Scene> scene;
  io::PlanTask task;
  Planner planner;
  HorizonReport report;
};

double farthest(const ActedTask& acted, const State& state) {
  return positionDifference(acted.scene->model, acted.task.q.back(), state.q).cwiseAbs().maxCoeff();
}

// Upright and at rest, four seconds after the plan ends.
TEST(RecedingHorizon, AnAcrobotSwingsUpAndStays) {
  ActedTask acted("acrobot");
  acted.plan(false);
  const State end = acted.act({.period = 0.02}, 6.0);
  EXPECT_LT(farthest(acted, end), 0.02);
  EXPECT_LT(end.v.cwiseAbs().maxCoeff(), 0.05);
  EXPECT_EQ(acted.report.ticks, 299);
  EXPECT_EQ(acted.report.failed, 0);
}

// Ten steps of the simulator are one of the plan, whose error is theirs.
TEST(RecedingHorizon, ActsAPlanOutWithoutMakingItAnew) {
  ActedTask acted("cart_pole");
  acted.plan(false);
  const State end = acted.act({}, 2.0);
  const VectorX off = positionDifference(acted.scene->model, acted.planner.plan().q.back(), end.q);
  EXPECT_LT(off.cwiseAbs().maxCoeff(), 0.1);
  EXPECT_EQ(acted.report.ticks, 0);
}

TEST(RecedingHorizon, GivesTheSameBitsAgain) {
  ActedTask first("cart_pole"), again("cart_pole");
  first.plan(false), again.plan(false);
  EXPECT_EQ(first.act({.period = 0.02}, 1.0).q, again.act({.period = 0.02}, 1.0).q);
}

TEST(RecedingHorizon, RefusesWhatIsOutOfRange) {
  ActedTask acted("cart_pole");
  EXPECT_THROW(RecedingHorizon(acted.planner, {.period = 0.06}), ModelError);
  EXPECT_THROW(RecedingHorizon(acted.planner, {.period = -0.01}), ModelError);
  EXPECT_THROW(RecedingHorizon(acted.planner, {.iterations = -1}), ModelError);
  // Nothing was planned.
  EXPECT_FALSE(RecedingHorizon(acted.planner).begin(acted.scene->initial));
}

TEST(RecedingHorizon, AHopperStands) {
  ActedTask acted("hopper");
  acted.plan(true);
  const State end = acted.act({.period = 0.02}, 4.0);
  EXPECT_NEAR(end.q[1], 0.61, 0.15);
}

}  // namespace
}  // namespace softgauss::test

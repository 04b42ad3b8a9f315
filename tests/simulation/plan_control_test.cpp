// SPDX-License-Identifier: Apache-2.0
/// Plans of scenes, acted out in their simulator: what that costs.

#include "softgauss/io/simulation/plan_control.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "softgauss/engine/engine.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "tests/io/temp_folder.hpp"
#include "tests/simulation/data_file.hpp"

namespace softgauss::test {
namespace {

std::string taskFile(const std::string& name) {
  return std::string(SOFTGAUSS_SOURCE_DIR) + "/data/plans/" + name + ".yaml";
}

/// A task in its simulator.
struct PlannedScene {
  explicit PlannedScene(const std::string& path, bool receding = false)
      : file(path),
        sim(Simulation::load(file)),
        control(sim.scene(), io::readPlanTask(file, sim.model(), sim.scene().initial), receding) {}
  /// What a run of so long costs.
  MotionCost act(double seconds) {
    control.solve();
    control.attach(sim.controller());
    control.begin(sim.state());
    const double h = sim.model().options.timestep;
    while (sim.time() < seconds - 0.5 * h) {
      control.update(sim.state());
      if (isRefused(sim.step())) break;
      control.addStep(sim.controller().control, h);
    }
    control.update(sim.state());
    return control.cost(sim.state());
  }

  std::string file;
  Simulation sim;
  PlanControl control;
};

// The controls of the plan in steps of the plan, without the simulator's mechanisms, are the plan.
TEST(PlanControl, CountsAPlanAsThePlannerDoes) {
  for (const char* task : {"acrobot", "cart_pole"}) {
    PlannedScene planned(taskFile(task));
    const planning::MotionPlan plan = planned.control.solve();
    const Model& bare = planned.control.planner().model();
    Data data(bare);
    State state = planned.sim.scene().initial;
    planned.control.begin(state);
    Input input;
    input.controlled = allTrees(bare);
    double rates = 0.0;
    for (std::size_t t = 0; t < plan.tau.size(); ++t) {
      planned.control.update(state);
      const double rate = planned.control.plannedRate(state.time).value().total();
      EXPECT_EQ(planned.control.rate(plan.q[t], plan.v[t], plan.tau[t]).total(), rate);
      rates += bare.options.timestep * rate;
      // An unstable plan is not left by rounding.
      state.q = plan.q[t], state.v = plan.v[t];
      input.tau = plan.tau[t];
      ASSERT_EQ(step(bare, input, state, data, nullptr), SolveStatus::converged);
      planned.control.addStep(plan.tau[t], bare.options.timestep);
      state.time = static_cast<double>(t + 1) * bare.options.timestep;
    }
    planned.control.update(state);
    EXPECT_TRUE(planned.control.hasEnded(state.time));
    EXPECT_FALSE(planned.control.plannedRate(state.time));
    EXPECT_NEAR(rates + planned.control.finalPlanned(), plan.cost, 1e-12 * plan.cost) << task;
    EXPECT_NEAR(planned.control.cost(state).total(), plan.cost, 1e-9 * plan.cost) << task;
  }
}

// Steps of 2 ms for one of 50: what the plan's longer step errs by is all that is left.
TEST(PlanControl, CostsWhatWasPlanned) {
  for (const char* task : {"acrobot", "cart_pole", "hopper"}) {
    PlannedScene planned(taskFile(task));
    const MotionCost cost = planned.act(planned.control.duration());
    const double asked = planned.control.planner().plan().cost;
    EXPECT_NEAR(cost.total(), asked, 0.05 * asked) << task;
  }
}

// A plan that recedes keeps what it has reached.
TEST(PlanControl, RecedesToItsTargetAndStays) {
  PlannedScene planned(taskFile("cart_pole"), true);
  const MotionCost cost = planned.act(5.0);
  EXPECT_LT(planned.control.farthest(planned.sim.state()).second, 0.01);
  EXPECT_LT(planned.sim.state().v.cwiseAbs().maxCoeff(), 0.01);
  EXPECT_LT(cost.total(), 1.1 * planned.control.planner().plan().cost);
  EXPECT_EQ(planned.control.report().failed, 0);
}

// It stands up within 1.5 s, and takes a push of 0.5 m/s two seconds later.
TEST(PlanControlLong, AHumanoidRisesAndTakesAPush) {
  std::ifstream in(taskFile("humanoid_rises"));
  std::string text(std::istreambuf_iterator<char>(in), {});
  const std::string urdf = "../robots/humanoid.urdf";
  text.replace(text.find(urdf), urdf.size(), robot("humanoid"));
  text += "\nwrenches:\n  - {link: pelvis, force: [204.5, 0, 0], start: 3.5, end: 3.6}\n";
  const io::TempFolder folder;
  PlannedScene planned(folder.write("pushed.yaml", text), true);
  EXPECT_NEAR(planned.sim.model().totalMass() * 0.5 / 0.1, 204.5, 1.0);
  planned.act(6.0);
  EXPECT_EQ(planned.control.report().failed, 0);
  EXPECT_LT(planned.control.farthest(planned.sim.state()).second, 0.2);
  EXPECT_NEAR(planned.sim.pose("pelvis").p.z(), planned.control.task().q.back()[2], 0.05);
}

TEST(PlanControl, RefusesWhatPlansDoNotKnow) {
  const io::TempFolder folder;
  const std::string text = "robots:\n  - {urdf: " + robot("arm") +
                           "}\nactuators:\n  - {name: motor, joints: {elbow_pitch: 2}}\nplan: {}\n";
  const std::string file = folder.write("scene.yaml", text);
  const auto scene = loadScene(file);
  EXPECT_THROW(PlanControl(*scene, io::readPlanTask(file, scene->model, scene->initial), false),
               ModelError);
}

TEST(PlanControl, TellsThatThereIsNoPlan) {
  PlannedScene planned(taskFile("acrobot"));
  planned.control.planner().cost.effort.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(planned.control.solve(), PlanError);
}

}  // namespace
}  // namespace softgauss::test

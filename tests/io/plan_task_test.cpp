// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/plan_task.hpp"

#include "scene_folder.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// The plan of a scene with the sample robot, floating.
io::PlanTask planOf(const SceneFolder& folder) {
  const io::SceneFile scene = folder.read();
  const Model model = scene.builder.build();
  return io::readPlanTask(folder.file, model, scene.initialState(model));
}

std::string sceneThatPlans(const std::string& plan) {
  return "robots:\n  - {urdf: sample.urdf, position: [0, 0, 1], joints: {shoulder: 0.3}}\n" + plan;
}

TEST(PlanTask, HasTheWeightsAndTheTargetOfItsFile) {
  const SceneFolder folder(sceneThatPlans(R"(plan:
  step: 0.02
  knots: 10
  contacts: {margin: 0.02, d_min: 0.01, stages: 3, factor: 0.5, iterations: 7, end: planning}
  iterations: {infeasible: 4, feasible: 9, rho: 0.1}
  running: {position: {all: 1, shoulder: 3, base_rotation: 5}, velocity: 0.5}
  final: {position: 2}
  effort: 0.1
  root_force: {base_position: 7, base_rotation: 8}
  target: {joints: {shoulder: 0.7}, move: [1, 0, 0], steady: true}
  mpc: {rate: 100, iterations: 2, contacts: planning, keep: false}
)"));
  const Model model = folder.read().builder.build();
  const io::PlanTask task = planOf(folder);
  EXPECT_EQ(task.steps.step, 0.02);
  EXPECT_EQ(task.steps.knots, 10);
  ASSERT_TRUE(task.contacts.has_value());
  EXPECT_EQ(task.contacts->contacts.margin, 0.02);
  EXPECT_EQ(task.contacts->contacts.dMin, 0.01);
  EXPECT_EQ(task.contacts->stages, 3);
  EXPECT_EQ(task.contacts->infeasible, 7);
  EXPECT_FALSE(task.endsOnOwnContacts);
  EXPECT_NEAR(task.mpc.period, 0.01, 1e-15);
  EXPECT_EQ(task.mpc.iterations, 2);
  EXPECT_FALSE(task.recedesOnOwnContacts);
  EXPECT_FALSE(task.mpc.keepsEnd);
  EXPECT_EQ(task.options.infeasible, 4);
  EXPECT_EQ(task.options.inPhaseI.rho, 0.1);
  const Body& shoulder = model.bodies[idx(model.findJoint("shoulder"))];
  EXPECT_EQ(task.running.position[shoulder.v], 3.0);
  EXPECT_EQ(task.running.position[0], 1.0);
  EXPECT_EQ(task.running.position[4], 5.0);
  EXPECT_EQ(task.running.velocity[shoulder.v], 0.5);
  EXPECT_EQ(task.final.position[shoulder.v], 2.0);
  EXPECT_EQ(task.final.velocity[shoulder.v], 0.0);
  EXPECT_EQ(task.rootForce[1], 7.0);
  EXPECT_EQ(task.rootForce[3], 8.0);
  EXPECT_EQ(task.effort[1], 0.0);
  // From the start to the target at one speed, where it rests.
  ASSERT_EQ(task.q.size(), 11u);
  EXPECT_NEAR(task.q.front()[shoulder.q], 0.3, 1e-15);
  EXPECT_NEAR(task.q[5][shoulder.q], 0.5, 1e-15);
  EXPECT_NEAR(task.q[5][0], 0.5, 1e-15);
  EXPECT_NEAR(task.q.back()[0], 1.0, 1e-15);
  EXPECT_NEAR(task.v[5][0], 1.0 / 0.2, 1e-12);
  EXPECT_EQ(task.v.back()[0], 0.0);
}

TEST(PlanTask, TellsWhatIsWrongAndWhere) {
  const struct {
    const char *plan, *says;
  } cases[] = {
      {"", "plan"},
      {"plan: 3\n", "expected a map"},
      {"plan: {steps: 0.05}\n", "steps"},
      {"plan: {step: 0}\n", "step"},
      {"plan: {knots: 2.5}\n", "whole number"},
      {"plan: {effort: 0}\n", "effort"},
      {"plan: {running: {position: {elbw: 1}}}\n", "elbw"},
      {"plan: {target: {joints: {elbw: 1}}}\n", "elbw"},
      {"plan: {contacts: {d_min: 1}}\n", "less than 1"},
      {"plan: {iterations: {infeasible: 0}}\n", "infeasible"},
      {"plan: {step: 2}\n", "at most 1 s"},
      {"plan: {knots: 100001}\n", "from 1 to 100000"},
      {"plan: {mpc: {rate: 19}}\n", "at least 20"},
      {"plan: {mpc: {rate: 50, contacts: none}}\n", "planning"},
  };
  for (const auto& c : cases) {
    const SceneFolder folder(sceneThatPlans(c.plan));
    try {
      planOf(folder);
      ADD_FAILURE() << c.plan;
    } catch (const ModelError& error) {
      EXPECT_NE(std::string(error.what()).find(c.says), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("scene.yaml:"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/plan_task.hpp"

#include <fmt/format.h>

#include "scene_folder.hpp"
#include "softgauss/engine/dynamics/energy.hpp"
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

/// Where the scene starts.
State startOf(const SceneFolder& folder, const Model& model) {
  return folder.read().initialState(model);
}

// A link's point, its turn and the centre of mass, off by known amounts from where the robot
// starts.
TEST(PlanTask, PricesPlacesOfLinks) {
  const SceneFolder bare(sceneThatPlans("plan: {}\n"));
  const Model model = bare.read().builder.build();
  const State start = startOf(bare, model);
  Kinematics kinematics(model);
  computeKinematics(model, start, kinematics);
  const Transform X = framePose(model, kinematics, model.findFrame("arm"));
  const Vector3 offset(0.1, 0.2, 0.3), p = X * offset, c = centerOfMass(model, kinematics);
  const auto list = [](const Vector3& x) {
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x[0], x[1], x[2]);
  };
  const Matrix3& R = X.R;
  const Vector3 rpy(std::atan2(R(2, 1), R(2, 2)), -std::asin(R(2, 0)) + 0.1,
                    std::atan2(R(1, 0), R(0, 0)));
  const SceneFolder folder(sceneThatPlans(
      "plan:\n  final:\n    points: {arm: {target: " + list(p + Vector3(0.3, 0, 0.4)) +
      ", weight: 8, point: [0.1, 0.2, 0.3]}}\n  running:\n    orientations: {arm: {rpy: " +
      list(rpy) + ", weight: 200}}\n    center_of_mass: {target: " + list(c + Vector3(0, 2, 0)) +
      ", weight: 3}\n"));
  const io::PlanTask task = planOf(folder);
  planning::Planner planner(model, task.steps);
  task.setCosts(planner);
  const auto costs = [&](const auto& terms) {
    std::vector<double> found;
    for (const auto& term : terms)
      found.push_back(term->value({model, start.q, start.v, 0, &kinematics}));
    return found;
  };
  const std::vector<double> last = costs(planner.cost.final), running = costs(planner.cost.running);
  ASSERT_EQ(last.size(), 2u);  // the state's is first
  EXPECT_NEAR(last[1], 0.5 * 8.0 * 0.25, 1e-12);
  ASSERT_EQ(running.size(), 3u);
  // Pitch is not about a fixed axis where there is a roll, but the angle is the same.
  EXPECT_NEAR(running[1], 0.5 * 200.0 * 0.01, 1e-9);
  EXPECT_NEAR(running[2], 0.5 * 3.0 * 4.0, 1e-12);
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
      {"plan: {mpc: {seconds: 0}}\n", "seconds"},
      {"plan: {final: {points: {amr: {target: [0, 0, 1], weight: 1}}}}\n", "did you mean 'arm'"},
      {"plan: {final: {points: {arm: {weight: 1}}}}\n", "a place in the world"},
      {"plan: {final: {points: {arm: {target: [0, 0, 1], weight: 0}}}}\n", "weight"},
      {"plan: {running: {orientations: {arm: {weight: 1}}}}\n", "roll, pitch and yaw"},
      {"plan: {final: {center_of_mass: {target: [0, 0]}}}\n", "center_of_mass"},
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

// SPDX-License-Identifier: Apache-2.0

/// Physics does not depend on who has goals: what a control does not act on moves as without one.

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/islands/crowd.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// Adds a rod of 1 kg that its joint's dry friction holds out level: 100 N m against 4.9.
void addRod(ModelBuilder& builder, const std::string& name, const Vector3& p) {
  ModelBuilder one(name);
  one.base = BaseKind::fixed;
  one.X_WRoot = Transform{Matrix3::Identity(), p};
  one.link(emptyLink(name + "_stand"));
  one.link(boxLink(name, 1.0, Vector3(0.5, 0.02, 0.02), Vector3(0.5, 0.0, 0.0)));
  JointSpec joint =
      jointSpec(name + "_joint", JointType::revolute, name + "_stand", name, {}, Vector3::UnitY());
  joint.dryFriction = 100.0;
  joint.effort = 0.0;
  one.joint(joint);
  builder.add(one, "");
}

/// A robot that lies and one on a table of two cubes; a rod, a heap and a cube by themselves.
ModelBuilder robotsAndBystanders() {
  ModelBuilder builder = robotsAndCubes();
  addRod(builder, "rod", Vector3(0.0, 3.0, 1.0));
  addCube(builder, "bottom", Vector3(-3.0, 0.0, 0.1));
  addCube(builder, "top", Vector3(-3.0, 0.05, 0.3));
  return builder;
}

// What friction holds it holds, also while somebody else reaches for something: without (5.6) the
// rod sinks by 0.3 rad in these ten seconds. With it, at 1e-9 of the creep, by what the load of the
// first step has done: 3e-10 rad, whoever has goals.
TEST(Bystanders, StickWhileOthersHaveGoals) {
  for (const gdd::GddSolver solver :
       {gdd::GddSolver::activeSet, gdd::GddSolver::augmentedLagrangian}) {
    ModelBuilder builder("arm and rod");
    builder.add(chain(3), "arm");
    addRod(builder, "rod", Vector3(3.0, 0.0, 1.0));
    const Model model = builder.build();
    const int frame = model.findFrame("rod");
    const Body& rod = model.bodies[model.frames[static_cast<std::size_t>(frame)].body];
    gdd::GoalDirectedController controller(model);
    controller.solver = solver;
    controller.goals.push_back(
        std::make_unique<gdd::Reach>(model, "arm/link2", Vector3(0.3, 0.2, 0.2)));
    controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
    State state(model);
    Data data(model);
    const double q = state.q[rod.q];
    while (state.time < 10.0)
      ASSERT_NE(controller.step(model, {}, state, data, nullptr), SolveStatus::notFinite);
    EXPECT_GT(controller.control.cwiseAbs().maxCoeff(), 1.0);
    EXPECT_SMALL(state.q[rod.q] - q, 1e-6);
  }
}

// A row is as soft as under a control where the control acts on one of its two trees, and only
// there: bit for bit as passive beside.
TEST(Bystanders, HaveTheRowsOfAPassiveScene) {
  const Model model = robotsAndBystanders().build();
  gdd::GoalDirectedController controller(model);
  Input input;
  controller.limits.markControlled(model, input.controlled);
  ASSERT_EQ(input.controlled.size(), model.trees.size());
  int robots = 0;
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    EXPECT_EQ(input.controlled[t] != 0, model.trees[t].actuated);
    robots += input.controlled[t];
  }
  EXPECT_EQ(robots, 2);

  collision::SceneContacts contacts(model);
  Data passive(model), controlled(model);
  State state(model);
  for (int i = 0; i < 200; ++i)
    ASSERT_NE(step(model, {}, state, passive, &contacts), SolveStatus::notFinite);
  computeStages(model, {}, state, passive, &contacts);
  computeStages(model, input, state, controlled, &contacts);
  const auto soft = [&](int bodyA, int bodyB) {
    const auto of = [&](int body) {
      const int tree = model.bodies[body].tree;
      return tree >= 0 && input.controlled[static_cast<std::size_t>(tree)] != 0;
    };
    return of(bodyA) || of(bodyB);
  };
  const PyramidalContact& rows = controlled.constraints.contact;
  const PyramidalContact& asPassive = passive.constraints.contact;
  ASSERT_EQ(rows.rowCount(), asPassive.rowCount());
  int same = 0;
  for (int i = 0; i < rows.rowCount(); ++i) {
    const ContactRows& of = rows.contactsWithRows()[static_cast<std::size_t>(rows.contactOfRow(i))];
    const std::size_t row = static_cast<std::size_t>(i);
    if (soft(of.bodyA, of.bodyB)) {
      EXPECT_LE(rows.D[row], asPassive.D[row]);  // what sticks is hardened by (5.7)
    } else {
      EXPECT_EQ(rows.D[row], asPassive.D[row]);
      EXPECT_EQ(rows.reference[row], asPassive.reference[row]);
      ++same;
    }
  }
  EXPECT_GT(same, 0);
  ASSERT_EQ(controlled.constraints.dryFriction.rowCount(), 1);
  EXPECT_EQ(controlled.constraints.dryFriction.D[0], passive.constraints.dryFriction.D[0]);
}

}  // namespace
}  // namespace softgauss::test

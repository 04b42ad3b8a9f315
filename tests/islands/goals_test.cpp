// SPDX-License-Identifier: Apache-2.0

/// Goals act on islands as they act on the scene.

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/islands/goal_crowd.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {
namespace {

int robotOf(const Model& model, const std::string& link) {
  return model
      .bodies[static_cast<std::size_t>(
          model.frames[static_cast<std::size_t>(model.findFrame(link))].body)]
      .robot;
}

/// One goal of every kind that islands may have, for both creatures together or for one.
std::vector<std::unique_ptr<gdd::Goal>> goalsOfEveryKind(const Model& model, Random& random) {
  std::vector<std::unique_ptr<gdd::Goal>> goals;
  const Vector3 place(0.3, 0.2, 0.6);
  goals.push_back(std::make_unique<gdd::Reach>(model, "lying_3", place));
  auto pose = std::make_unique<gdd::Reach>(model, "lifted_3", place);
  pose->R_WTarget = random.rotation();
  pose->metric = gdd::LinkMetric::consistent;
  goals.push_back(std::move(pose));
  goals.push_back(std::make_unique<gdd::Hold>(model, "lifted_0"));
  goals.push_back(std::make_unique<gdd::LookAt>(model, "lying_2", place));
  goals.push_back(std::make_unique<gdd::LinkAcceleration>(model, "lifted_2", Vector3(1, 2, 3)));
  auto acceleration = std::make_unique<gdd::JointAcceleration>();
  auto posture = std::make_unique<gdd::JointPosture>();
  for (const char* joint : {"lying_1_joint", "lifted_2_joint"}) {
    acceleration->targets.push_back(gdd::jointTarget(model, joint, 3.0));
    posture->targets.push_back(gdd::jointTarget(model, joint, 0.5));
  }
  goals.push_back(std::move(acceleration));
  goals.push_back(std::move(posture));
  goals.push_back(std::make_unique<gdd::Posture>(model.q0));
  goals.push_back(std::make_unique<gdd::VirtualDamping>());
  auto inverse = std::make_unique<gdd::VirtualDamping>();
  inverse->metric = gdd::DampingMetric::inverseInertia;
  goals.push_back(std::move(inverse));
  const int robot = robotOf(model, "lifted_0");
  goals.push_back(std::make_unique<gdd::CenterOfMass>(model, robot, place));
  goals.push_back(std::make_unique<gdd::MomentumGoal>(model, robot));
  goals.push_back(std::make_unique<gdd::CapturePoint>(model, robot, Vector3(0.1, 0.0, 0.0)));
  return goals;
}

/// ∇ℓ of a goal at a, of a state whose stages `data` holds.
VectorX slope(const gdd::Goal& goal, const Model& model, const State& state, const Data& data,
              const VectorX& a) {
  gdd::GoalCost cost(model.nv);
  cost.clear();
  goal.addCost({model, state, data}, cost);
  VectorX Ma(model.nv), gradient(model.nv);
  data.inertia.M.multiply(a, Ma);
  cost.gradient(a, Ma, gradient);
  return gradient;
}

TEST(GoalsOfIslands, TogetherCostWhatTheGivenOnesCost) {
  Random random(1);
  const Model model = robotsAndCubes().build();
  const int trees = static_cast<int>(model.trees.size());
  const std::vector<std::vector<int>> islands = {{0}, {1, 2, 3}, {4}};
  std::vector<SubModel> parts;
  for (const std::vector<int>& island : islands) parts.emplace_back(model, island);
  const auto goals = goalsOfEveryKind(model, random);
  State state(model);
  Data data(model);
  ASSERT_EQ(trees, 5);
  for (int trial = 0; trial < 5; ++trial) {
    integratePosition(model, random.vector(model.nv, 0.2), 1.0, state.q);
    state.v = random.vector(model.nv, 1.0);
    ASSERT_NE(computeStages(model, {}, state, data, nullptr), SolveStatus::notFinite);
    const VectorX a = random.vector(model.nv, 10.0);
    for (const auto& goal : goals) {
      const VectorX whole = slope(*goal, model, state, data, a);
      VectorX together = VectorX::Zero(model.nv);
      int about = 0;
      for (const SubModel& part : parts) {
        const std::unique_ptr<gdd::Goal> here = goal->within(model, part);
        if (!here) continue;
        ++about;
        State own(part.model);
        Data ownData(part.model);
        part.gather(model, state, own);
        computeStages(part.model, {}, own, ownData, nullptr);
        VectorX ownA(part.model.nv);
        part.gather(model, a, ownA);
        part.scatter(model, slope(*here, part.model, own, ownData, ownA), together);
        EXPECT_EQ(here->name(), goal->name());
      }
      EXPECT_GE(about, 1) << goal->name();
      EXPECT_GT(whole.cwiseAbs().maxCoeff(), 0.0) << goal->name();
      // The same sums in the same order, but for those of robots that a whole matrix has between.
      EXPECT_SMALL((together - whole).cwiseAbs().maxCoeff() / whole.cwiseAbs().maxCoeff(), 1e-13);
    }
  }
}

TEST(GoalsOfIslands, AgreeWithTheJointSolve) {
  for (const gdd::GddSolver solver :
       {gdd::GddSolver::activeSet, gdd::GddSolver::augmentedLagrangian}) {
    GoalCrowd crowd(robotsAndCubes().build());
    crowd.controller.solver = solver;
    crowd.reach("lying_3", Vector3(0.2, 0.1, 0.5)).weight = 100.0;
    crowd.controller.goals.push_back(std::make_unique<gdd::Posture>(crowd.model.q0));
    crowd.controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
    crowd.start();
    gdd::GoalDirectedController joint(crowd.model);
    const SubModel whole = allOf(crowd.model);
    joint.solver = solver;
    for (const auto& goal : crowd.controller.goals) {
      joint.goals.push_back(goal->within(crowd.model, whole));
    }
    collision::SceneContacts contacts(crowd.model);
    Data data(crowd.model);
    double gap = 0.0, controlGap = 0.0;
    for (int i = 0; i < 300; ++i) {
      State state = crowd.islands->state();
      ASSERT_NE(joint.step(crowd.model, {}, state, data, &contacts), SolveStatus::notFinite);
      ASSERT_TRUE(crowd.steps(1));
      EXPECT_EQ(crowd.islands->islandStats().controlled, 2);
      const VectorX& a = data.forward.a;
      gap = std::max(gap, (crowd.islands->acceleration() - a).cwiseAbs().maxCoeff() /
                              std::max(1.0, a.cwiseAbs().maxCoeff()));
      const VectorX& u = joint.control;
      controlGap = std::max(controlGap, (crowd.controller.control - u).cwiseAbs().maxCoeff() /
                                            std::max(1.0, u.cwiseAbs().maxCoeff()));
    }
    // Solver 2 stops where what is promised is 1e-12 of the objective, solver 1 where its own
    // gradient is small: where contacts are near-rigid, flat directions make 1e-8 and 5e-8 of that.
    EXPECT_SMALL(gap, 2e-8);
    EXPECT_SMALL(controlGap, 1e-7);
  }
}

TEST(GoalsOfIslands, ConcernNobodyElse) {
  // Whoever else is there, the bits of a robot and of what it touches are the same.
  ModelBuilder few = ground(), many = ground();
  for (ModelBuilder* builder : {&few, &many}) {
    if (builder == &many) addCreature(*builder, "other", Vector3(-3.0, 0.0, 1.0));
    addCreature(*builder, "robot", Vector3(0.0, 0.0, 0.05));
    addCube(*builder, "cube", Vector3(0.05, 0.0, 1.4));  // falls onto it
    if (builder == &many)
      for (int i = 0; i < 3; ++i) addCube(*builder, "far" + std::to_string(i), {5.0, 0.0, 0.3 * i});
  }
  GoalCrowd alone(few.build()), together(many.build());
  for (GoalCrowd* crowd : {&alone, &together}) {
    crowd->reach("robot_3", Vector3(0.3, 0.0, 0.3));
    crowd->controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  }
  together.controller.goals.push_back(std::make_unique<gdd::Hold>(together.model, "other_3"));
  alone.start(), together.start();
  const Body& one = alone.model.bodies[static_cast<std::size_t>(alone.body("robot_0"))];
  const Body& two = together.model.bodies[static_cast<std::size_t>(together.body("robot_0"))];
  const int nq = alone.model.nq, nv = alone.model.nv;
  bool touched = false;
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(alone.steps(1) && together.steps(1));
    touched = touched || alone.islands->islandStats().islands == 1;
    ASSERT_EQ(alone.islands->state().q.segment(one.q, nq),
              together.islands->state().q.segment(two.q, nq))
        << "step " << i;
    ASSERT_EQ(alone.controller.control.segment(one.v, nv),
              together.controller.control.segment(two.v, nv));
  }
  EXPECT_TRUE(touched);
}

TEST(GoalsOfIslands, KeepActuatorsAndPriceOfForce) {
  // Gears, and a diagonal and a dense price: the same control, alone and beside another robot.
  for (const bool dense : {false, true}) {
    VectorX controls[2];
    for (const bool together : {false, true}) {
      ModelBuilder builder = ground();
      if (together) addCreature(builder, "other", Vector3(3.0, 0.0, 1.0));
      addCreature(builder, "robot", Vector3(0.0, 0.0, 1.0));
      GoalCrowd crowd(builder.build());
      const int nv = crowd.model.nv;
      const int first = crowd.model.bodies[static_cast<std::size_t>(crowd.body("robot_1"))].v;
      gdd::Actuator geared{.name = "geared"}, pair{.name = "pair"};
      geared.pulls = {{first, 20.0}};
      geared.lower = -0.5, geared.upper = 0.5;
      pair.pulls = {{first + 1, 1.0}, {first + 2, -1.0}};
      crowd.controller.limits = gdd::ControlLimits(crowd.model, {pair, geared});
      VectorX diagonal = VectorX::Ones(nv);
      diagonal.tail(9) = VectorX::LinSpaced(9, 3.0, 4.0);
      MatrixX whole = diagonal.asDiagonal();
      whole(nv - 3, nv - 2) = whole(nv - 2, nv - 3) = 0.5;
      crowd.controller.forceMetric =
          dense ? gdd::ForceMetric::dense(whole) : gdd::ForceMetric::diagonal(diagonal);
      crowd.reach("robot_3", Vector3(0.5, 0.3, 1.2)).weight = 10.0;
      crowd.start();
      ASSERT_TRUE(crowd.steps(20));
      controls[together] = crowd.controller.commands;
      EXPECT_LE(std::abs(crowd.controller.commands[1]), 0.5);
      EXPECT_DOUBLE_EQ(crowd.controller.control[first], 20.0 * crowd.controller.commands[1]);
    }
    EXPECT_GT(controls[0].cwiseAbs().minCoeff(), 0.0);
    EXPECT_APPROX(controls[1], controls[0], 1e-9);
  }
}

TEST(GoalsOfIslands, RefuseWhatTiesThem) {
  ModelBuilder builder = ground();
  addCreature(builder, "one", Vector3(0.0, 0.0, 1.0));
  addCreature(builder, "two", Vector3(3.0, 0.0, 1.0));
  const Model model = builder.build();
  // What is refused names who ties.
  const auto refused = [&](auto&& change, const std::string& who) {
    gdd::GoalDirectedController controller(model);
    change(controller);
    gdd::GoalDirectedIslands controls(model, controller);
    try {
      Islands(model, nullptr, {}, &controls);
    } catch (const ModelError& error) {
      return std::string(error.what()).find(who) != std::string::npos;
    }
    return false;
  };
  EXPECT_FALSE(refused([](auto&) {}, ""));
  EXPECT_TRUE(refused(
      [](auto& c) {
        c.goals.push_back(std::make_unique<gdd::ValueGoal>(
            [](const VectorX&, const VectorX&, VectorX&, MatrixX&) { return 0.0; }));
      },
      "goal 'value'"));
  EXPECT_TRUE(refused(
      [&](auto& c) {
        gdd::Actuator tendon{.name = "tendon"};
        tendon.pulls = {{6, 1.0}, {9 + 6, 1.0}};
        c.limits = gdd::ControlLimits(model, {tendon});
      },
      "tendon"));
  EXPECT_TRUE(refused(
      [&](auto& c) {
        MatrixX R = MatrixX::Identity(model.nv, model.nv);
        R(6, 15) = R(15, 6) = 0.1;
        c.forceMetric = gdd::ForceMetric::dense(R);
      },
      "control cost"));
}

}  // namespace
}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0

/// A step with goals solves each island by itself: its robots, and what these touch.

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/model/saved_state.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"
#include "tests/islands/crowd.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// A scene that is stepped as one, with goals.
struct Scene {
  explicit Scene(const ModelBuilder& builder)
      : model(builder.build()), contacts(model), state(model), data(model), controller(model) {}

  gdd::Reach& reach(const std::string& link, const Vector3& place) {
    auto goal = std::make_unique<gdd::Reach>(model, link, place);
    gdd::Reach& added = *goal;
    controller.goals.push_back(std::move(goal));
    return added;
  }
  void step() {
    ASSERT_EQ(controller.step(model, {}, state, data, &contacts), SolveStatus::converged);
  }
  const Body& body(const std::string& name) const {
    return model.bodies[static_cast<std::size_t>(
        model.frames[static_cast<std::size_t>(model.findFrame(name))].body)];
  }
  /// Islands on which the control acts.
  int controlled() const {
    int count = 0;
    for (int i = 0; i < controller.islands().size(); ++i)
      count += controller.islands().controls(i) > 0;
    return count;
  }

  const Model model;
  collision::SceneContacts contacts;
  State state;
  Data data;
  gdd::GoalDirectedController controller;
};

// Whoever else is there, falls and collides, or has goals of its own: the bits of a robot, of its
// control and of what falls onto it are the same.
TEST(GoalIslands, ConcernNobodyElse) {
  ModelBuilder few = ground(), many = ground();
  for (ModelBuilder* builder : {&few, &many}) {
    builder->options.substepAngle = kInfinity;  // else all that a control acts on takes the same
    if (builder == &many) addCreature(*builder, "other", Vector3(-3.0, 0.0, 1.0));
    addCreature(*builder, "robot", Vector3(0.0, 0.0, 0.05));
    addCube(*builder, "cube", Vector3(0.05, 0.0, 1.4));  // falls onto it
    if (builder == &many)
      for (int i = 0; i < 4; ++i)
        addCube(*builder, "far" + std::to_string(i), Vector3(5.0 + 0.1 * i, 0.0, 0.3 + 0.3 * i));
  }
  Scene alone(few), together(many);
  for (Scene* scene : {&alone, &together}) {
    scene->reach("robot_3", Vector3(0.3, 0.0, 0.3));
    scene->controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  }
  together.controller.goals.push_back(std::make_unique<gdd::Hold>(together.model, "other_3"));
  const Body &one = alone.body("robot_0"), &two = together.body("robot_0");
  const int nq = alone.model.nq, nv = alone.model.nv;
  int touched = 0, repeatedForOthers = 0;
  for (int i = 0; i < 600; ++i) {
    alone.step(), together.step();
    ASSERT_EQ(alone.state.q.segment(one.q, nq), together.state.q.segment(two.q, nq)) << i;
    ASSERT_EQ(alone.controller.control.segment(one.v, nv),
              together.controller.control.segment(two.v, nv));
    touched += alone.controller.islands().size() == 1;
    repeatedForOthers += together.data.stats.repeats > alone.data.stats.repeats;
  }
  EXPECT_GT(touched, 10);
  EXPECT_GT(repeatedForOthers, 10);
}

// What no control acts on moves as forward dynamics has it, and counts as that.
TEST(GoalIslands, LeaveTheOthersToForwardDynamics) {
  Scene scene(robotsAndCubes());
  scene.reach("lying_3", Vector3(0.2, 0.1, 0.5)).weight = 100.0;
  for (int i = 0; i < 100; ++i) {
    scene.step();
    ASSERT_EQ(scene.controlled(), 2);
    EXPECT_LE(scene.data.stats.realised, 1e-12);
  }
  const int alone = scene.body("alone").tree;
  for (std::size_t t = 0; t < scene.model.trees.size(); ++t) {
    const bool moved = static_cast<int>(t) != alone;
    EXPECT_EQ(scene.controller.controlled()[t] != 0, moved);
  }
}

// Islands find the minimum of the one problem: the price of another scene couples all its robots,
// by 1e-18 of itself, and so makes one island of these.
TEST(GoalIslands, AgreeWithTheOneProblem) {
  Scene islands(robotsAndCubes()), one(robotsAndCubes());
  const int nv = islands.model.nv;
  MatrixX R = MatrixX::Identity(nv, nv);
  const int first = one.body("lying_1").v, second = one.body("lifted_1").v;
  R(first, second) = R(second, first) = 1e-18;
  islands.controller.forceMetric = gdd::ForceMetric::diagonal(VectorX::Ones(nv));
  one.controller.forceMetric = gdd::ForceMetric::dense(R);
  for (Scene* scene : {&islands, &one}) {
    scene->reach("lying_3", Vector3(0.2, 0.1, 0.5)).weight = 100.0;
    scene->controller.goals.push_back(std::make_unique<gdd::Posture>(scene->model.q0));
    scene->controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
  }
  double gap = 0.0, controlGap = 0.0;
  for (int i = 0; i < 300; ++i) {
    one.state = islands.state;
    islands.step(), one.step();
    ASSERT_EQ(islands.controlled(), 2);
    ASSERT_EQ(one.controlled(), 1);
    const VectorX &a = one.data.forward.a, &u = one.controller.control;
    gap = std::max(gap, (islands.data.forward.a - a).cwiseAbs().maxCoeff() /
                            std::max(1.0, a.cwiseAbs().maxCoeff()));
    controlGap = std::max(controlGap, (islands.controller.control - u).cwiseAbs().maxCoeff() /
                                          std::max(1.0, u.cwiseAbs().maxCoeff()));
  }
  // Solver 2 stops where what is promised is 1e-12 of the objective: where contacts are near-rigid,
  // flat directions make 1e-8 and 5e-8 of that.
  EXPECT_SMALL(gap, 2e-8);
  EXPECT_SMALL(controlGap, 1e-7);
}

// A term of the cost, an actuator or a price that couples robots makes one problem of theirs.
TEST(GoalIslands, AreOneWhereAnythingCouplesThem) {
  ModelBuilder builder = ground();
  addCreature(builder, "one", Vector3(0.0, 0.0, 1.0));
  addCreature(builder, "two", Vector3(3.0, 0.0, 1.0));
  const auto islandsWith = [&](auto&& change) {
    Scene scene(builder);
    scene.reach("one_3", Vector3(0.2, 0.1, 0.5));
    change(scene.controller, scene.model);
    scene.step();
    return scene.controlled();
  };
  const auto dofOf = [](const Model& model, const char* link) {
    return model
        .bodies[static_cast<std::size_t>(
            model.frames[static_cast<std::size_t>(model.findFrame(link))].body)]
        .v;
  };
  EXPECT_EQ(islandsWith([](auto&, const Model&) {}), 2);
  EXPECT_EQ(islandsWith([](auto& c, const Model& model) {
              c.goals.push_back(std::make_unique<gdd::ValueGoal>(
                  [n = model.nv](const VectorX&, const VectorX&, VectorX& slope, MatrixX& second) {
                    slope.setZero(2 * n);
                    second.setZero(2 * n, 2 * n);
                    return 0.0;
                  }));
            }),
            1);
  EXPECT_EQ(islandsWith([&](auto& c, const Model& model) {
              gdd::Actuator tendon{.name = "tendon"};
              tendon.pulls = {{dofOf(model, "one_1"), 1.0}, {dofOf(model, "two_1"), 1.0}};
              c.limits = gdd::ControlLimits(model, {tendon});
            }),
            1);
  EXPECT_EQ(islandsWith([&](auto& c, const Model& model) {
              MatrixX R = MatrixX::Identity(model.nv, model.nv);
              const int i = dofOf(model, "one_1"), j = dofOf(model, "two_1");
              R(i, j) = R(j, i) = 0.1;
              c.forceMetric = gdd::ForceMetric::dense(R);
            }),
            1);
  EXPECT_EQ(islandsWith([&](auto& c, const Model& model) {
              c.forceMetric = gdd::ForceMetric::dense(MatrixX::Identity(model.nv, model.nv));
            }),
            2);
  EXPECT_EQ(islandsWith([](auto& c, const Model&) {
              c.solver = gdd::GddSolver::augmentedLagrangian;  // has no islands
            }),
            1);
}

// A budget is shared: no robot has to do with what the ones before it in the model have left.
TEST(GoalIslands, ShareABudget) {
  Scene scene(robotsAndCubes());
  scene.reach("lying_3", Vector3(0.2, 0.1, 0.5)).weight = 100.0;
  scene.reach("lifted_3", Vector3(2.0, 0.3, 0.6)).weight = 100.0;
  scene.controller.iterationBudget = 2;
  const Body& last = scene.body("lifted_1");
  int changed = 0;
  double before = 0.0;
  for (int i = 0; i < 100; ++i) {
    ASSERT_FALSE(isRefused(
        scene.controller.step(scene.model, {}, scene.state, scene.data, &scene.contacts)));
    EXPECT_LE(scene.controller.report.iterations,
              2 * (scene.data.stats.parts + scene.data.stats.repeats));
    changed += scene.controller.control[last.v] != before;
    before = scene.controller.control[last.v];
  }
  EXPECT_GT(changed, 90);
}

/// A rod that hangs by its end from a point 5 m above p.
ModelBuilder hangingRod(const Vector3& p) {
  ModelBuilder builder("rod");
  builder.base = BaseKind::floating;
  builder.X_WRoot.p = p + Vector3(0.0, 0.0, 5.0);
  LinkSpec rod;
  rod.name = "rod";
  rod.mass = 1.0;
  rod.I_Lcm = Vector3(0.02, 0.02, 0.001).asDiagonal();
  builder.link(rod);
  ConnectSpec end;
  end.linkA = "rod";
  end.linkB = "world";
  end.p_LAP.z() = 0.25;
  end.p_LBP = builder.X_WRoot.p + end.p_LAP;
  return builder.connect(end);
}

// A price ties a robot to a rod that turns so fast that it takes parts of its own: the robot moves
// as its goal has it, though the rod comes first.
TEST(GoalIslands, AreSolvedWhereSomeAreLeftToPartsOfTheirOwn) {
  ModelBuilder builder = ground();
  builder.add(hangingRod(Vector3(5.0, 0.0, 0.0)), "");
  addCreature(builder, "robot", Vector3(2.0, 0.0, 0.05));
  Scene scene(builder);
  scene.reach("robot_3", Vector3(2.2, 0.1, 0.5));
  MatrixX R = MatrixX::Identity(scene.model.nv, scene.model.nv);
  const int first = scene.body("rod").v, second = scene.body("robot_1").v;
  R(first, second) = R(second, first) = 0.1;
  scene.controller.forceMetric = gdd::ForceMetric::dense(R);
  scene.state.v.segment<6>(first) << -0.75, 10.0, 0.0, 40.0, 3.0, 0.0;  // about its end
  int apart = 0;
  for (int i = 0; i < 20; ++i) {
    ASSERT_FALSE(isRefused(
        scene.controller.step(scene.model, {}, scene.state, scene.data, &scene.contacts)));
    apart += scene.data.parts->leavesAny();
    EXPECT_GT(scene.data.forward.a.segment<9>(scene.body("robot_0").v).cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_LE(scene.data.stats.realised, 1e-9);
  }
  EXPECT_GT(apart, 10);
}

// What either solver leaves in a state is a state that can be kept.
TEST(GoalIslands, LeaveAStateThatCanBeRestored) {
  for (const auto solver : {gdd::GddSolver::activeSet, gdd::GddSolver::augmentedLagrangian}) {
    Scene scene(robotsAndCubes());
    scene.controller.solver = solver;
    scene.reach("lying_3", Vector3(0.2, 0.1, 0.5));
    for (int i = 0; i < 3; ++i) scene.step();
    EXPECT_EQ(hash(restore(scene.model, save(scene.model, scene.state))), hash(scene.state));
  }
}

// How long the search of an island has waited is of the state too.
TEST(GoalIslands, GoOnAsTheStateTells) {
  Scene first(robotsAndCubes()), second(robotsAndCubes());
  for (Scene* scene : {&first, &second}) {
    scene->reach("lying_3", Vector3(0.2, 0.1, 0.5)).weight = 100.0;
    scene->reach("lifted_3", Vector3(2.0, 0.3, 0.6));
  }
  for (int i = 0; i < 120; ++i) first.step();
  second.state = first.state;
  for (int i = 0; i < 120; ++i) {
    first.step(), second.step();
    ASSERT_EQ(hash(first.state), hash(second.state)) << i;
  }
}

}  // namespace
}  // namespace softgauss::test

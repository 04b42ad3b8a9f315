// SPDX-License-Identifier: Apache-2.0
/// Goals of chosen joints, and the times between which a goal acts.

#include "tests/gdd/goal_check.hpp"
#include "tests/gdd/robot_scene.hpp"

namespace softgauss::test {
namespace {

/// Every other joint of one degree of freedom, with random targets.
std::vector<gdd::JointTarget> randomTargets(const Model& model, Random& random) {
  std::vector<gdd::JointTarget> targets;
  for (int b = 1; b < model.bodyCount(); b += 2)
    if (model.bodies[b].dofs == 1)
      targets.push_back(gdd::jointTarget(model, model.jointNames[b], random.uniform(-2.0, 2.0)));
  return targets;
}

TEST(JointGoals, KeepTheLawsOfCosts) {
  expectLawsOfGoals([](const Scene& scene, Random& random) {
    auto goal = std::make_unique<gdd::JointAcceleration>();
    goal->targets = randomTargets(scene.model, random);
    goal->weight = random.uniform(0.1, 1e3);
    return goal;
  });
  expectLawsOfGoals([](const Scene& scene, Random& random) {
    auto goal = std::make_unique<gdd::JointPosture>();
    goal->targets = randomTargets(scene.model, random);
    goal->weight = random.uniform(0.1, 1e3);
    return goal;
  });
}

/// A posture goal whose reference is away by d from where the scene is: q* = q ⊕ d. Floating bases
/// are turned away too, by less than half a turn.
std::unique_ptr<gdd::Posture> postureAway(const Scene& scene, const VectorX& d, Random& random) {
  VectorX reference = scene.state.q;
  integratePosition(scene.model, d, 1.0, reference);
  auto goal = std::make_unique<gdd::Posture>(reference);
  goal->weight = random.uniform(0.1, 1e3);
  goal->stiffness = random.uniform(0.0, 100.0);
  goal->damping = random.uniform(0.0, 20.0);
  return goal;
}

TEST(Posture, KeepsTheLawsOfCosts) {
  expectLawsOfGoals([](const Scene& scene, Random& random) {
    return postureAway(scene, random.vector(scene.model.nv, 1.0), random);
  });
}

// (9.7), ½ w (a − k_p d + k_d v)ᵀ M (a − k_p d + k_d v), counted from a = 0.
TEST(Posture, IsItsFormulaWithAFloatingBaseTurnedAway) {
  int floating = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed + 70);
    const Scene scene = looseScene(seed);
    for (const Body& body : scene.model.bodies) floating += body.joint == JointKind::floating;
    const VectorX d = random.vector(scene.model.nv, 1.0);
    const auto goal = postureAway(scene, d, random);
    // Joints of one degree of freedom may move on from there.
    VectorX rate = VectorX::Zero(scene.model.nv), bend = rate;
    for (int b = 1; b < scene.model.bodyCount(); b += 2) {
      const Body& body = scene.model.bodies[b];
      if (body.dofs != 1) continue;
      gdd::JointTarget& target = goal->moving.emplace_back();
      target.body = b;
      target.value = goal->q[body.q];
      target.velocity = rate[body.v] = random.uniform(-2.0, 2.0);
      target.acceleration = bend[body.v] = random.uniform(-5.0, 5.0);
    }
    const MatrixX M = scene.data->inertia.M.dense();
    const auto formula = [&](const VectorX& a) {
      const VectorX e = a - bend - goal->stiffness * d - goal->damping * (rate - scene.state.v);
      return 0.5 * goal->weight * e.dot(M * e);
    };
    const VectorX a = random.vector(scene.model.nv, 10.0), zero = 0.0 * a;
    const GoalCheck check(scene, *goal);
    const double wanted = formula(a) - formula(zero), size = formula(a) + formula(zero);
    EXPECT_SMALL((check.value(a) - check.value(zero) - wanted) / size, 1e-12);
  }
  EXPECT_GE(floating, 20);
}

// ½ w Σ M_ii (a_i − a*_i)², counted from a = 0.
TEST(JointGoals, WeighTheInertiaThatTheJointMoves) {
  const Scene scene = drivenArm(3);
  Random random(3);
  gdd::JointAcceleration goal;
  goal.targets = randomTargets(scene.model, random);
  goal.weight = 7.0;
  ASSERT_GE(goal.targets.size(), 3u);
  const VectorX a = random.vector(scene.model.nv, 5.0);
  const MatrixX M = scene.data->inertia.M.dense();
  double expected = 0.0;
  for (const gdd::JointTarget& target : goal.targets) {
    const int i = scene.model.bodies[target.body].v;
    expected += 3.5 * M(i, i) * (std::pow(a[i] - target.value, 2) - std::pow(target.value, 2));
  }
  const GoalCheck check(scene, goal);
  EXPECT_NEAR(check.value(a) - check.value(0.0 * a), expected, 1e-12 * std::abs(expected));
}

// (9.9) and (9.28), counted from a = 0.
TEST(JointGoals, FollowPositionsAndVelocitiesOfTheirTargets) {
  const Scene scene = drivenArm(4);
  Random random(4);
  gdd::JointPosture posture;
  posture.targets = randomTargets(scene.model, random);
  gdd::JointVelocity velocity;
  velocity.targets = posture.targets;
  const VectorX a = random.vector(scene.model.nv, 5.0);
  double ofPosture = 0.0, ofVelocity = 0.0;
  for (gdd::JointTarget& target : posture.targets) {
    target.velocity = random.uniform(-2.0, 2.0);
    target.acceleration = random.uniform(-5.0, 5.0);
    const Body& body = scene.model.bodies[target.body];
    const double q = scene.state.q[body.q], v = scene.state.v[body.v];
    const double M = scene.data->inertia.M.dense()(body.v, body.v);
    const auto add = [&](double& sum, double wished) {
      sum += 500.0 * M * (std::pow(a[body.v] - wished, 2) - std::pow(wished, 2));
    };
    add(ofPosture, target.acceleration + 50.0 * (target.value - q) + 15.0 * (target.velocity - v));
    add(ofVelocity, 20.0 * (target.value - v));
  }
  const GoalCheck check(scene, posture), speeds(scene, velocity);
  EXPECT_NEAR(check.value(a) - check.value(0.0 * a), ofPosture, 1e-12 * std::abs(ofPosture));
  EXPECT_NEAR(speeds.value(a) - speeds.value(0.0 * a), ofVelocity, 1e-12 * std::abs(ofVelocity));
}

// A heavy goal of every joint leaves nothing to gravity: the arm does what it is told.
TEST(JointGoals, JointsAccelerateAsTold) {
  const Scene scene = drivenArm(5);
  gdd::JointAcceleration goal;
  goal.weight = 1e9;
  for (int b = 1; b < scene.model.bodyCount(); ++b)
    if (scene.model.bodies[b].dofs == 1)
      goal.targets.push_back(gdd::jointTarget(scene.model, scene.model.jointNames[b], 0.1 * b));
  const VectorX a = GoalCheck(scene, goal).solved();
  for (const gdd::JointTarget& target : goal.targets)
    EXPECT_NEAR(a[scene.model.bodies[target.body].v], target.value, 1e-4);
}

TEST(JointGoals, UnknownOrFloatingJointsAreRefused) {
  const Scene scene = looseScene(1);
  EXPECT_THROW(gdd::jointTarget(scene.model, "no such joint", 0.0), ModelError);
  int scalar = 0, others = 0;
  for (int b = 1; b < scene.model.bodyCount(); ++b) {
    const std::string& joint = scene.model.jointNames[b];
    if (scene.model.bodies[b].dofs == 1) {
      ++scalar;
      EXPECT_NO_THROW(gdd::jointTarget(scene.model, joint, 0.0)) << joint;
      EXPECT_THROW(gdd::jointTarget(scene.model, joint, kNaN), ModelError) << joint;
      EXPECT_THROW(gdd::jointTarget(scene.model, joint, kInfinity), ModelError) << joint;
    } else {
      others += scene.model.bodies[b].joint == JointKind::floating;
      EXPECT_THROW(gdd::jointTarget(scene.model, joint, 0.0), ModelError) << joint;
    }
  }
  EXPECT_GT(scalar, 0);
  EXPECT_GT(others, 0);
}

// One joint of the arm is led to a place; the others are told nothing but to be slow.
TEST(JointGoals, OneJointIsLedToItsPlace) {
  RobotScene r("arm");
  int body = 1;
  while (r.model.bodies[body].dofs != 1) ++body;
  auto goal = std::make_unique<gdd::JointPosture>();
  const double start = r.state.q[r.model.bodies[body].q];
  goal->targets = {gdd::jointTarget(r.model, r.model.jointNames[body], start + 0.3)};
  r.controller.goals.push_back(std::move(goal));
  r.addDamping().weight = 10.0;
  for (int i = 0; i < 1000; ++i) ASSERT_NE(r.step(), SolveStatus::notFinite);
  EXPECT_NEAR(r.state.q[r.model.bodies[body].q], start + 0.3, 0.01);
}

// (9.6) with either metric is its formula, up to the constant, and its derivatives are its own.
TEST(VirtualDamping, IsItsFormulaInBothMetrics) {
  Random random(41);
  const Scene scene = looseScene(7);
  const int n = scene.model.nv;
  const VectorX v = scene.state.v;
  const MatrixX M = scene.data->inertia.M.dense();
  for (const auto metric : {gdd::DampingMetric::inertia, gdd::DampingMetric::inverseInertia}) {
    gdd::VirtualDamping goal;
    goal.weight = 0.7;
    goal.rate = 3.0;
    goal.metric = metric;
    GoalCheck check(scene, goal);
    EXPECT_SMALL(check.differenceError(random), 1e-12);
    const auto formula = [&](const VectorX& a) {
      const VectorX e = a + 3.0 * v;
      const VectorX We = metric == gdd::DampingMetric::inertia ? VectorX(M * e) : M.llt().solve(e);
      return 0.35 * e.dot(We);
    };
    const VectorX a = random.vector(n, 10.0), zero = VectorX::Zero(n);
    const double wanted = formula(a) - formula(zero), size = formula(a) + formula(zero);
    EXPECT_SMALL((check.value(a) - check.value(zero) - wanted) / size, 1e-12);
  }
}

// [start, end): the same run, step for step, as one whose goal is put in and taken out by hand.
TEST(GoalTimes, AGoalActsFromItsStartUntilItsEnd) {
  RobotScene timed("arm"), manual("arm");
  const Vector3 target(0.5, 0.3, 0.5);
  timed.addDamping();
  manual.addDamping();
  gdd::Reach& reach = timed.addReach("hand", target);
  reach.startTime = 0.01;
  reach.endTime = 0.03;
  int acted = 0;
  for (int i = 0; i < 30; ++i) {
    const double t = manual.state.time;
    const bool acts = t >= 0.01 && t < 0.03;
    if (acts && manual.controller.goals.size() == 1) manual.addReach("hand", target);
    if (!acts && manual.controller.goals.size() == 2) manual.controller.goals.pop_back();
    acted += acts;
    timed.step();
    manual.step();
    ASSERT_EQ(timed.state.q, manual.state.q) << "at " << t << " s";
  }
  EXPECT_NEAR(acted, 10, 1);
}

}  // namespace
}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0
/// Targets that move are followed without lag: ë + k_d ė + k_p e = 0 (9.25), and so are speeds.

#include "tests/gdd/goal_check.hpp"
#include "tests/gdd/robot_scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

/// A coordinate that swings along x, in closed form: for who writes a trajectory of his own.
class Swing final : public gdd::Trajectory {
 public:
  int size() const override { return 3; }
  bool movesAt(double) const override { return true; }
  gdd::CoordinateMotion at(double t, int i) const override {
    if (i > 0) return {};
    return {0.3 * std::sin(4.0 * t), 1.2 * std::cos(4.0 * t), -4.8 * std::sin(4.0 * t)};
  }
};

/// By how much the error of a cart that follows a swing is off its closed form.
double worstOfCart(double timestep) {
  Model model = slidingCart(2.0);
  model.options.timestep = timestep;
  State state(model);
  Data data(model);
  state.q[0] = 0.1;  // the target starts at 0 with 1.2 m/s
  gdd::GoalDirectedController controller(model);
  auto reach = std::make_unique<gdd::Reach>(model, "cart", Vector3::Zero());
  reach->trajectory = std::make_shared<Swing>();
  reach->weight = 1e9;
  controller.goals.push_back(std::move(reach));
  double worst = 0.0;
  while (state.time < 1.5) {
    EXPECT_EQ(controller.step(model, {}, state, data, nullptr), SolveStatus::converged);
    const double t = state.time, e = state.q[0] - Swing().at(t, 0).p;
    // k_p = 100/s², k_d = 20/s: (e₀ + (ė₀ + 10 e₀) t) exp(−10 t).
    worst = std::max(worst, std::abs(e - (0.1 + (-1.2 + 1.0) * t) * std::exp(-10.0 * t)));
  }
  return worst;
}

TEST(MovingTarget, ErrorDecaysAsASpringDamper) {
  // An acceleration that is held for a step is late by half of it, h/2 · 19 m/s³ over k_p; the
  // decay from rest is off by as much.
  const double coarse = worstOfCart(1e-3), fine = worstOfCart(2.5e-4);
  EXPECT_SMALL(coarse, 1e-3);
  EXPECT_GT(coarse, 3.0 * fine) << coarse << " m, " << fine << " m";
}

struct Following {
  double worst = 0.0;  ///< after the first half second [m]
  double last = 0.0;   ///< at the end [m]
};

/// The arm's hand on a circle of 10 cm at 0.5 Hz, with default gains, at 2 ms.
Following followCircle(bool withRates) {
  RobotScene r("arm");
  r.model.options.timestep = 0.002;
  const Vector3 start = r.position("hand");
  gdd::CircleTrajectory::Circle circle;
  circle.center = Vector3(0.5, 0.0, 0.5);
  circle.radius = 0.1;
  circle.frequency = 0.5;
  circle.normal = Vector3::UnitX();
  const auto path = std::make_shared<gdd::CircleTrajectory>(circle);
  gdd::Reach& reach = r.addReach("hand", path->pointAt(0.0).p);
  reach.weight = 1e5;
  if (withRates) {
    reach.trajectory = path;
    reach.minimumJerk = gdd::MinimumJerk{.p_start = start, .duration = 0.5};
  }
  r.addDamping();
  Following result;
  while (r.state.time < 4.0) {
    if (!withRates) reach.p_WTarget = path->pointAt(r.state.time).p;
    if (r.step() != SolveStatus::converged) ADD_FAILURE() << "at " << r.state.time << " s";
    result.last = (r.position("hand") - path->pointAt(r.state.time).p).norm();
    if (r.state.time > 0.5) result.worst = std::max(result.worst, result.last);
  }
  return result;
}

TEST(MovingTarget, AnArmFollowsACircleToAMillimetre) {
  EXPECT_LT(followCircle(true).worst, 1e-3);
  // Without the rates of the target it lags by 0.1 m |ω² − i k_d ω|/|k_p − ω² + i k_d ω|, ω = π/s.
  EXPECT_NEAR(followCircle(false).last, 0.0579, 5e-4);
}

// The way to a target that moves begins at rest and ends with the target's place and velocity: on
// it a body that moves so costs nothing. The way is sampled by differences.
TEST(MovingTarget, AWayToItCostsNothingWhereItIsFollowed) {
  Scene scene(freeBody(boxLink("body", 2.0, Vector3(0.1, 0.2, 0.3))).build());
  Random random(4);
  gdd::Reach goal(scene.model, "body", Vector3::Zero());
  goal.weight = 2.0;
  goal.trajectory = std::make_shared<Swing>();
  goal.minimumJerk = gdd::MinimumJerk{random.vector3(1.0), 0.2, 1.5, Matrix3::Identity()};
  const auto way = [&](double t) -> Vector3 {
    const double s = std::clamp((t - 0.2) / 1.5, 0.0, 1.0);
    const double share = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
    return goal.minimumJerk->p_start + share * (Swing().pointAt(t).p - goal.minimumJerk->p_start);
  };
  constexpr double h = 1e-4;
  for (const double t : {0.1, 0.4, 0.9, 1.5, 2.0}) {
    scene.state.time = t;
    scene.state.q.head<3>() = way(t);
    scene.state.v.setZero();
    scene.state.v.head<3>() = (way(t + h) - way(t - h)) / (2.0 * h);
    ASSERT_EQ(scene.stages(), SolveStatus::converged);
    VectorX a = VectorX::Zero(6);
    a.head<3>() = (way(t + h) - 2.0 * way(t) + way(t - h)) / (h * h);
    // Differences are wrong by h² times fourth rates of some 300, and by rounding over h².
    EXPECT_SMALL(std::sqrt(GoalCheck(scene, goal).value(a)), 1e-5) << t;
    EXPECT_EQ(goal.steadyAt(t), false);
  }
}

TEST(MovingTarget, StandsStillWhereNothingMovesIt) {
  const Scene arm = drivenArm(1);
  gdd::Reach reach(arm.model, "link6", Vector3::Zero());
  gdd::LookAt look(arm.model, "link6", Vector3::UnitX());
  gdd::CenterOfMass centre(arm.model, 0, Vector3::Zero());
  const MatrixX p = (MatrixX(3, 2) << 0, 1, 0, 1, 0, 1).finished();
  const auto path = std::make_shared<gdd::KnotTrajectory>(std::vector<double>{1.0, 2.0}, p);
  const auto expectSteadiness = [&](auto& goal) {
    EXPECT_TRUE(goal.steadyAt(1.5));
    goal.v_WTarget.x() = 0.1;
    EXPECT_FALSE(goal.steadyAt(1.5));
    goal.trajectory = path;
    EXPECT_TRUE(goal.steadyAt(0.5) && goal.steadyAt(2.5));
    EXPECT_FALSE(goal.steadyAt(1.5));
    goal.restAt(Vector3::Zero());
    EXPECT_TRUE(goal.steadyAt(1.5));
  };
  expectSteadiness(reach);
  expectSteadiness(look);
  expectSteadiness(centre);
  gdd::Posture posture(arm.state.q);
  gdd::JointPosture joints;
  EXPECT_TRUE(posture.steadyAt(1.5) && joints.steadyAt(1.5));
  posture.moving.push_back(gdd::jointTarget(arm.model, arm.model.jointNames[1], 0.1));
  posture.moving[0].trajectory = path;
  joints.targets = posture.moving;
  EXPECT_FALSE(posture.steadyAt(1.5) || joints.steadyAt(1.5));
  EXPECT_TRUE(posture.steadyAt(2.5) && joints.steadyAt(2.5));
}

// A goal is judged by its distance to the target at that time.
TEST(MovingTarget, ErrorIsThatToTheTargetNow) {
  Scene scene(freeBody(boxLink("body", 2.0, Vector3(0.1, 0.2, 0.3))).build());
  gdd::Reach goal(scene.model, "body", Vector3(9.0, 9.0, 9.0));
  goal.trajectory = std::make_shared<Swing>();
  scene.state.time = 0.7;
  scene.state.q.head<3>() = Swing().pointAt(0.7).p + Vector3(0.0, 0.0, 0.25);
  ASSERT_EQ(scene.stages(), SolveStatus::converged);
  EXPECT_NEAR(*goal.error({scene.model, scene.state, *scene.data}), 0.25, 1e-12);
}

TEST(JointVelocity, AWheelReachesItsSpeedAtTheRate) {
  ModelBuilder builder("wheel");
  builder.link(emptyLink("world")).link(boxLink("wheel", 3.0, Vector3(0.2, 0.05, 0.2)));
  JointSpec axle = jointSpec("axle", JointType::continuous, "world", "wheel", {}, Vector3::UnitY());
  builder.joint(axle);
  Model model = builder.build();
  model.options.timestep = 1e-3;
  State state(model);
  Data data(model);
  gdd::GoalDirectedController controller(model);
  auto goal = std::make_unique<gdd::JointVelocity>();
  goal->targets = {gdd::jointTarget(model, "axle", 5.0)};
  goal->weight = 1e6;
  controller.goals.push_back(std::move(goal));
  double worst = 0.0;
  while (state.time < 0.5) {
    ASSERT_EQ(controller.step(model, {}, state, data, nullptr), SolveStatus::converged);
    worst = std::max(worst, std::abs(state.v[0] - 5.0 * (1.0 - std::exp(-20.0 * state.time))));
  }
  // An acceleration that is held for a step: 5 rad/s · β h/(2 e).
  EXPECT_SMALL(worst, 0.02);
  EXPECT_NEAR(state.v[0], 5.0, 1e-3);
}

}  // namespace
}  // namespace softgauss::test

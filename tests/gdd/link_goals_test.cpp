// SPDX-License-Identifier: Apache-2.0
/// Goals of links: pose, look-at, hold. Their costs against the motion of the links itself.

#include "softgauss/engine/core/rotation.hpp"
#include "tests/gdd/goal_check.hpp"
#include "tests/gdd/robot_scene.hpp"

namespace softgauss::test {
namespace {

std::string randomLinkName(const Model& model, Random& random) {
  return model.frames[randomMovingFrame(model, random)].name;
}

Vector3 rotationVector(const Matrix3& R) { return quaternionLog(Quaternion(R)); }

std::unique_ptr<gdd::Reach> randomPose(const Model& model, Random& random) {
  auto goal = std::make_unique<gdd::Reach>(model, randomLinkName(model, random),
                                           random.vector3(1.0), random.vector3(0.2));
  goal->R_WTarget = random.rotation();
  goal->weight = random.uniform(1.0, 100.0);
  goal->rotationWeight = random.uniform(0.1, 10.0);
  goal->v_WTarget = random.vector3(1.0);
  goal->a_WTarget = random.vector3(5.0);
  return goal;
}

std::unique_ptr<gdd::LookAt> randomLookAt(const Model& model, Random& random) {
  auto goal =
      std::make_unique<gdd::LookAt>(model, randomLinkName(model, random), random.vector3(2.0),
                                    random.vector3(2.0), random.vector3(0.2));
  goal->weight = random.uniform(0.1, 10.0);
  goal->v_WTarget = random.vector3(1.0);
  goal->a_WTarget = random.vector3(5.0);
  return goal;
}

TEST(LinkGoals, KeepTheLawsOfCosts) {
  expectLawsOfGoals([](const Scene& s, Random& random) { return randomPose(s.model, random); });
  expectLawsOfGoals([](const Scene& s, Random& random) {
    auto goal = randomPose(s.model, random);
    goal->metric = gdd::LinkMetric::consistent;
    if (random.chance(0.5)) goal->R_WTarget.reset();
    return goal;
  });
  expectLawsOfGoals([](const Scene& s, Random& random) {
    auto goal = std::make_unique<gdd::LinkAcceleration>(s.model, randomLinkName(s.model, random),
                                                        random.vector3(5.0), random.vector3(0.2));
    if (random.chance(0.5)) goal->angular = random.vector3(5.0);
    if (random.chance(0.5)) goal->metric = gdd::LinkMetric::consistent;
    return goal;
  });
  expectLawsOfGoals([](const Scene& s, Random& random) { return randomLookAt(s.model, random); });
  expectLawsOfGoals([](const Scene& s, Random& random) {
    auto goal = std::make_unique<gdd::Hold>(s.model, randomLinkName(s.model, random));
    goal->wholeLink = random.chance(0.5);
    return goal;
  });
}

/// A random scene, a random acceleration, and ℓ of a goal there.
struct AtAcceleration {
  Random random;
  Scene scene;
  VectorX a;
  explicit AtAcceleration(std::uint64_t seed)
      : random(seed + 77), scene(looseScene(seed)), a(random.vector(scene.model.nv, 5.0)) {}
  int body(int frame) const { return scene.model.frames[frame].body; }
  const Kinematics& k() const { return scene.data->kinematics; }

  Vector3 pointAcceleration(int frame, const Vector3& p_FP) const {
    return rateAlong(scene, a, [&](const Kinematics& kin) {
      const Vector3 p = framePose(scene.model, kin, frame) * p_FP;
      return pointVelocity(scene.model, kin, body(frame), p);
    });
  }
  Vector3 angularAcceleration(int frame) const {
    return rateAlong(scene, a, [&](const Kinematics& kin) {
      return Vector3(kin.V[static_cast<std::size_t>(body(frame))].angular);
    });
  }
};

// Differences over 1e-6 s of velocities of about 10: 1e-9 of their rates, that grow with ω².
constexpr double kDifference = 1e-6;

TEST(PoseGoal, WeighsTheAccelerationsOfPointAndLink) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    AtAcceleration at(seed);
    const auto goal = randomPose(at.scene.model, at.random);
    const Transform X = framePose(at.scene.model, at.k(), goal->frame);
    const Vector3 p = X * goal->p_FP;
    const int body = at.body(goal->frame);
    const Vector3 velocity = pointVelocity(at.scene.model, at.k(), body, p);
    const Vector3 wished = goal->a_WTarget + goal->stiffness * (goal->p_WTarget - p) +
                           goal->damping * (goal->v_WTarget - velocity);
    const Vector3 wishedTurn =
        goal->stiffness * rotationVector(*goal->R_WTarget * X.R.transpose()) -
        goal->damping * at.k().V[static_cast<std::size_t>(body)].angular;
    const double expected =
        0.5 * goal->weight *
            (at.pointAcceleration(goal->frame, goal->p_FP) - wished).squaredNorm() +
        0.5 * goal->rotationWeight *
            (at.angularAcceleration(goal->frame) - wishedTurn).squaredNorm();
    EXPECT_SMALL(GoalCheck(at.scene, *goal).value(at.a) / expected - 1.0, kDifference) << seed;
  }
}

TEST(LinkAccelerationGoal, WeighsTheAccelerationsThatAreAskedFor) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    AtAcceleration at(seed);
    gdd::LinkAcceleration goal(at.scene.model, randomLinkName(at.scene.model, at.random),
                               at.random.vector3(5.0), at.random.vector3(0.2));
    goal.angular = at.random.vector3(5.0);
    const double expected =
        0.5 * goal.weight *
            (at.pointAcceleration(goal.frame, goal.p_FP) - goal.linear).squaredNorm() +
        0.5 * goal.rotationWeight *
            (at.angularAcceleration(goal.frame) - *goal.angular).squaredNorm();
    EXPECT_SMALL(GoalCheck(at.scene, goal).value(at.a) / expected - 1.0, kDifference) << seed;
  }
}

// The wish along a minimum-jerk line is that of a link which has been on the line all along: the
// cost of a link that moves as the line does is zero. Here the line is sampled by differences.
TEST(PoseGoal, TurnsAboutOneAxisAlongAMinimumJerkLine) {
  Scene scene(freeBody(boxLink("body", 2.0, Vector3(0.1, 0.2, 0.3))).build());
  Random random(4);
  gdd::Reach goal(scene.model, "body", random.vector3(1.0));
  const Matrix3 R0 = random.rotation(), R1 = random.rotation();
  goal.R_WTarget = R1;
  gdd::MinimumJerk line;
  line.p_start = random.vector3(1.0);
  line.R_start = R0;
  line.duration = 2.0;
  goal.minimumJerk = line;
  const Vector3 turn = rotationVector(R1 * R0.transpose());
  const auto way = [](double s) { return s * s * s * (10.0 + s * (-15.0 + 6.0 * s)); };
  for (const double t : {0.3, 0.9, 1.4}) {
    const double h = 1e-3;
    const auto angle = [&](double time) { return way(time / 2.0); };
    const double rate = (angle(t + h) - angle(t - h)) / (2.0 * h);
    const double bend = (angle(t + h) - 2.0 * angle(t) + angle(t - h)) / (h * h);
    const Quaternion now(Matrix3(quaternionExp(angle(t) * turn).toRotationMatrix() * R0));
    const Vector3 way3 = goal.p_WTarget - line.p_start;
    scene.state.time = t;
    scene.state.q.head<3>() = line.p_start + angle(t) * way3;
    scene.state.q.tail<4>() << now.w(), now.x(), now.y(), now.z();
    const Matrix3 R = now.toRotationMatrix();
    scene.state.v << rate * way3, R.transpose() * (rate * turn);
    ASSERT_EQ(scene.stages(), SolveStatus::converged);
    VectorX a(6);
    a << bend * way3, R.transpose() * (bend * turn);  // ω × ω = 0: one axis
    // Differences of a quintic over 1e-3 s: 1e-5 relative, squared.
    EXPECT_SMALL(GoalCheck(scene, goal).value(a), 1e-5);
    EXPECT_GT(GoalCheck(scene, goal).value(0.0 * a), 1e-2);
  }
}

// J a = (w a* + what would happen anyway)/(1 + w), whatever the arm's configuration.
TEST(ConsistentMetric, TheShareOfAWishDependsOnTheWeightAlone) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene arm = drivenArm(seed);
    Random random(seed);
    gdd::Reach goal(arm.model, "link6", random.vector3(1.0), random.vector3(0.1));
    goal.metric = gdd::LinkMetric::consistent;
    goal.weight = random.uniform(0.1, 10.0);
    const gdd::GoalContext context{arm.model, arm.state, *arm.data};
    const Vector3 p = goal.position(context);
    gdd::GoalWorkspace work(7);
    const gdd::LinkRows rows(context, arm.model.frames[goal.frame].body, p, work);
    const Vector3 wished = goal.stiffness * (goal.p_WTarget - p) -
                           goal.damping * rows.velocity.head<3>() - rows.bias.head<3>();
    const VectorX fall = arm.data->inertia.M.dense().llt().solve(-arm.data->forces.c);
    const Vector3 expected =
        (goal.weight * wished + rows.J.topRows(3) * fall) / (1.0 + goal.weight);
    const Vector3 found = rows.J.topRows(3) * GoalCheck(arm, goal).solved();
    EXPECT_APPROX(found, expected, 1e-9) << "seed " << seed;
  }
}

// A hinge's link moves along one direction only: the others are left out, and nothing blows up.
TEST(ConsistentMetric, LeavesOutWhatCannotMove) {
  Scene scene(chain(1).build());
  ASSERT_EQ(scene.stages(), SolveStatus::converged);
  Random random(1);
  auto goal = randomPose(scene.model, random);
  goal->metric = gdd::LinkMetric::consistent;
  goal->weight = goal->rotationWeight = 3.0;
  const MatrixX H = GoalCheck(scene, *goal).hessian();
  ASSERT_EQ(H.size(), 1);
  EXPECT_NEAR(H(0, 0) / scene.data->inertia.M.dense()(0, 0), 3.0, 1e-9);
}

// The angle between axis and direction, by differences: its second derivative along the motion is
// what the cost measures, in the plane in which both lie.
TEST(LookAtGoal, WeighsTheAngularAccelerationAgainstThePlace) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    AtAcceleration at(seed);
    const auto goal = randomLookAt(at.scene.model, at.random);
    const Model& model = at.scene.model;
    const int body = at.body(goal->frame);
    const auto place = [&](const Kinematics& k) -> Vector3 {
      return framePose(model, k, goal->frame) * goal->p_FP;
    };
    // ω_d = d × ḋ, and ω, as features of the state and of the target dt later.
    const auto turningAt = [&](const Kinematics& k, double dt) -> Vector3 {
      const Vector3 s = goal->p_WTarget + dt * goal->v_WTarget - place(k);
      const Vector3 v =
          goal->v_WTarget + dt * goal->a_WTarget - pointVelocity(model, k, body, place(k));
      return k.V[static_cast<std::size_t>(body)].angular - s.cross(v) / s.squaredNorm();
    };
    const auto turning = [&](const Kinematics& k) { return turningAt(k, 0.0); };
    constexpr double h = 1e-6;
    const Vector3 byTarget = (turningAt(at.k(), h) - turningAt(at.k(), -h)) / (2.0 * h);
    const Vector3 u = framePose(model, at.k(), goal->frame).R * goal->axis_F;
    const Vector3 d = (goal->p_WTarget - place(at.k())).normalized();
    const Vector3 theta = std::acos(u.dot(d)) * u.cross(d).normalized();
    const Vector3 residual = rateAlong(at.scene, at.a, turning) + byTarget -
                             goal->stiffness * theta + goal->damping * turning(at.k());
    const double expected = 0.5 * goal->weight * (residual - u * u.dot(residual)).squaredNorm();
    EXPECT_SMALL(GoalCheck(at.scene, *goal).value(at.a) / expected - 1.0, kDifference) << seed;
  }
}

TEST(LookAtGoal, APlaceAtThePointItselfAsksForNothing) {
  const Scene arm = drivenArm(2);
  gdd::LookAt goal(arm.model, "link6", Vector3::Zero());
  goal.p_WTarget = framePose(arm.model, arm.data->kinematics, goal.frame).p;
  GoalCheck check(arm, goal);
  EXPECT_EQ(check.hessian().norm(), 0.0);
  // Straight away from it: any axis across will do, but one there must be.
  goal.p_WTarget -= framePose(arm.model, arm.data->kinematics, goal.frame).R.col(0);
  GoalCheck away(arm, goal);
  EXPECT_TRUE(away.gradient(VectorX::Zero(arm.model.nv)).allFinite());
  EXPECT_GT(away.gradient(VectorX::Zero(arm.model.nv)).norm(), 0.0);
}

TEST(HoldGoal, WeighsWhatChangesTheDecayOfVelocities) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    AtAcceleration at(seed);
    gdd::Hold goal(at.scene.model, randomLinkName(at.scene.model, at.random));
    goal.p_FP = at.random.vector3(0.2);
    goal.wholeLink = seed % 2 == 0;
    const int body = at.body(goal.frame);
    const Vector3 p = framePose(at.scene.model, at.k(), goal.frame) * goal.p_FP;
    const Vector3 slip = at.pointAcceleration(goal.frame, goal.p_FP) +
                         goal.rate * pointVelocity(at.scene.model, at.k(), body, p);
    const Vector3 twist = at.angularAcceleration(goal.frame) +
                          goal.rate * at.k().V[static_cast<std::size_t>(body)].angular;
    const double expected =
        0.5 * goal.weight * slip.squaredNorm() +
        (goal.wholeLink ? 0.5 * goal.rotationWeight * twist.squaredNorm() : 0.0);
    EXPECT_SMALL(GoalCheck(at.scene, goal).value(at.a) / expected - 1.0, kDifference) << seed;
  }
}

TEST(LinkGoals, UnknownLinksAreRefused) {
  const Scene arm = drivenArm(0);
  EXPECT_THROW(gdd::LookAt(arm.model, "no such link", Vector3::Zero()), ModelError);
  EXPECT_THROW(gdd::LookAt(arm.model, "link6", Vector3::Zero(), Vector3::Zero()), ModelError);
  EXPECT_THROW(gdd::Hold(arm.model, "no such link"), ModelError);
}

// ---- What the arm does --------------------------------------------------------------------------

TEST(LinkBehaviour, TheArmLooksAtThePlace) {
  RobotScene r("arm");
  const Vector3 place(0.8, 0.6, 0.2);
  auto goal = std::make_unique<gdd::LookAt>(r.model, "hand", place);
  goal->weight = 100.0;
  const gdd::LookAt& look = *goal;
  r.controller.goals.push_back(std::move(goal));
  r.addDamping().weight = 10.0;
  const auto angle = [&] {
    const Kinematics k = kinematicsAt(r.model, r.state);
    const Transform X = framePose(r.model, k, look.frame);
    return std::acos(std::min(1.0, (X.R * look.axis_F).dot((place - X.p).normalized())));
  };
  const double before = angle();
  ASSERT_GT(before, 0.2);
  for (int i = 0; i < 1500; ++i) ASSERT_NE(r.step(), SolveStatus::notFinite);
  EXPECT_LT(angle(), 0.02) << "from " << before << " rad";
}

TEST(LinkBehaviour, TheHandIsTurnedWhereItIs) {
  RobotScene r("arm");
  const Kinematics start = kinematicsAt(r.model, r.state);
  const Transform X = framePose(r.model, start, r.model.findFrame("hand"));
  gdd::Reach& pose = r.addReach("hand", X.p);
  const Matrix3 wished = axisRotation(Vector3::UnitZ(), 0.3) * X.R;
  pose.R_WTarget = wished;
  pose.weight = pose.rotationWeight = 1e4;
  pose.metric = gdd::LinkMetric::consistent;
  r.addDamping().weight = 1.0;
  for (int i = 0; i < 1500; ++i) ASSERT_NE(r.step(), SolveStatus::notFinite);
  const Transform end = framePose(r.model, kinematicsAt(r.model, r.state), pose.frame);
  EXPECT_SMALL((end.p - X.p).norm(), 0.01);
  EXPECT_SMALL(rotationVector(wished * end.R.transpose()).norm(), 0.02);
}

}  // namespace
}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0
/// Centre of mass, momentum, capture point: the centroidal momentum and the goals made of it.

#include "tests/gdd/goal_check.hpp"
#include "tests/gdd/robot_scene.hpp"

namespace softgauss::test {
namespace {

/// Momentum (p; k about the centre of mass) of a robot, summed body by body in the plain way.
struct PlainMomentum {
  double mass = 0.0;
  Vector3 centre = Vector3::Zero(), velocity = Vector3::Zero();
  Vector6 h = Vector6::Zero();

  PlainMomentum(const Model& model, const Kinematics& k, int robot) {
    for (int pass = 0; pass < 2; ++pass)
      for (int b = 1; b < model.bodyCount(); ++b) {
        const Body& body = model.bodies[b];
        if (body.robot != robot || body.massless) continue;
        const Vector3 p = k.X_WB[b] * body.com;
        const Vector3 v = pointVelocity(model, k, b, p);
        if (pass == 0) {
          mass += body.mass;
          centre += body.mass * p;
          velocity += body.mass * v;
          continue;
        }
        const Matrix3 R = k.X_WB[b].R;
        h.head<3>() += body.mass * v;
        h.tail<3>() += (p - centre / mass).cross(body.mass * v) +
                       R * (body.I_Bcm.matrix() * (R.transpose() * k.V[b].angular));
      }
    centre /= mass;
    velocity /= mass;
  }
};

Centroidal centroidalOf(const Scene& scene, int robot) {
  Centroidal c;
  computeCentroidal(scene.model, scene.data->kinematics, scene.data->inertia, robot, c);
  return c;
}

int robotOf(const Scene& scene, Random& random) {
  return scene.model.bodies[1 + random.index(scene.model.bodyCount() - 1)].robot;
}

TEST(CentroidalMomentum, IsThatOfTheBodiesAndItsRateThatOfTheMotion) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Scene scene = looseScene(seed);
    Random random(seed + 5);
    const int robot = robotOf(scene, random);
    const Centroidal c = centroidalOf(scene, robot);
    const PlainMomentum plain(scene.model, scene.data->kinematics, robot);
    EXPECT_NEAR(c.mass, plain.mass, 1e-13 * plain.mass);
    EXPECT_APPROX(c.p_WC, plain.centre, 1e-13);
    EXPECT_APPROX(c.v_WC, plain.velocity, 1e-12);
    EXPECT_APPROX(c.momentum, plain.h, 1e-12);
    EXPECT_APPROX(c.A * scene.state.v, plain.h, 1e-12);
    const VectorX a = random.vector(scene.model.nv, 5.0);
    const Vector6 rate = rateAlong(
        scene, a, [&](const Kinematics& k) { return PlainMomentum(scene.model, k, robot).h; });
    // Central differences over 1e-6 s.
    EXPECT_APPROX(Vector6(c.A * a + c.bias), rate, 1e-7);
  }
}

// What falls freely keeps its angular momentum about the centre of mass, and falls as a stone.
TEST(CentroidalMomentum, OfAFreeRobotChangesByItsWeightAlone) {
  for (int seed = 0; seed < 10; ++seed) {
    Random random(seed);
    ModelBuilder builder = randomFloatingTree(seed, false);
    builder.options.effects.remove(Effect::jointLimit);
    builder.options.effects.remove(Effect::damping);
    Scene scene(builder.build());
    scene.state = randomState(scene.model, random);
    ASSERT_EQ(scene.stages(), SolveStatus::converged);
    const Centroidal c = centroidalOf(scene, 0);
    const VectorX a = scene.data->inertia.M.dense().llt().solve(-scene.data->forces.c);
    Vector6 expected = Vector6::Zero();
    expected.head<3>() = c.mass * scene.model.options.gravity;
    EXPECT_APPROX(Vector6(c.A * a + c.bias), expected, 1e-10);
  }
}

std::unique_ptr<gdd::CenterOfMass> randomCenter(const Scene& scene, Random& random) {
  auto goal =
      std::make_unique<gdd::CenterOfMass>(scene.model, robotOf(scene, random), random.vector3(1.0));
  if (random.chance(0.5)) goal->axes[static_cast<std::size_t>(random.index(3))] = false;
  goal->v_WTarget = random.vector3(1.0);
  goal->a_WTarget = random.vector3(5.0);
  return goal;
}

std::unique_ptr<gdd::MomentumGoal> randomMomentum(const Scene& scene, Random& random) {
  auto goal = std::make_unique<gdd::MomentumGoal>(scene.model, robotOf(scene, random));
  goal->linear = random.vector3(5.0);
  goal->angular = random.vector3(5.0);
  return goal;
}

std::unique_ptr<gdd::CapturePoint> randomCapture(const Scene& scene, Random& random) {
  // A ground well below, so that there is a pendulum.
  auto goal = std::make_unique<gdd::CapturePoint>(scene.model, robotOf(scene, random),
                                                  random.vector3(1.0) - Vector3(0.0, 0.0, 5.0));
  goal->v_WTarget = Vector3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.0);
  return goal;
}

TEST(BalanceGoals, KeepTheLawsOfCosts) {
  expectLawsOfGoals([](const Scene& s, Random& random) { return randomCenter(s, random); });
  expectLawsOfGoals([](const Scene& s, Random& random) { return randomMomentum(s, random); });
  expectLawsOfGoals([](const Scene& s, Random& random) { return randomCapture(s, random); });
}

// Differences over 1e-6 s.
constexpr double kDifference = 1e-6;

TEST(BalanceGoals, WeighTheMotionOfTheWholeRobot) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = looseScene(seed);
    Random random(seed + 31);
    const VectorX a = random.vector(scene.model.nv, 5.0);
    const auto plain = [&](int robot) {
      return PlainMomentum(scene.model, scene.data->kinematics, robot);
    };
    const auto centre = randomCenter(scene, random);
    const PlainMomentum c = plain(centre->robot);
    const Vector3 acceleration = rateAlong(scene, a, [&](const Kinematics& k) {
      return PlainMomentum(scene.model, k, centre->robot).velocity;
    });
    Vector3 error = acceleration - centre->a_WTarget -
                    centre->stiffness * (centre->p_WTarget - c.centre) -
                    centre->damping * (centre->v_WTarget - c.velocity);
    for (int i = 0; i < 3; ++i)
      if (!centre->axes[static_cast<std::size_t>(i)]) error[i] = 0.0;
    double expected = 0.5 * centre->weight * error.squaredNorm();
    EXPECT_SMALL(GoalCheck(scene, *centre).value(a) / expected - 1.0, kDifference) << seed;

    const auto momentum = randomMomentum(scene, random);
    const Vector6 h = plain(momentum->robot).h;
    Vector6 wished;
    wished << momentum->linear, momentum->angular;
    const Vector6 off = rateAlong(scene, a,
                                  [&](const Kinematics& k) {
                                    return PlainMomentum(scene.model, k, momentum->robot).h;
                                  }) -
                        momentum->rate * (wished - h);
    expected = 0.5 * momentum->linearWeight * off.head<3>().squaredNorm() +
               0.5 * momentum->angularWeight * off.tail<3>().squaredNorm();
    EXPECT_SMALL(GoalCheck(scene, *momentum).value(a) / expected - 1.0, kDifference) << seed;
  }
}

// Where the capture goal is met, ξ moves to its target at the rate β: by differences of ξ itself.
TEST(BalanceGoals, TheCapturePointMovesAtItsRate) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = looseScene(seed);
    Random random(seed + 13);
    const auto goal = randomCapture(scene, random);
    const auto xi = [&](const Kinematics& k) -> Vector3 {
      const PlainMomentum m(scene.model, k, goal->robot);
      const double omega = std::sqrt(9.81 / (m.centre.z() - goal->p_WTarget.z()));
      return {m.centre.x() + m.velocity.x() / omega, m.centre.y() + m.velocity.y() / omega,
              goal->p_WTarget.z()};
    };
    const Vector3 now = xi(scene.data->kinematics);
    const auto position = goal->position({scene.model, scene.state, *scene.data});
    ASSERT_TRUE(position);
    EXPECT_APPROX(*position, now, 1e-12);
    const VectorX a = random.vector(scene.model.nv, 5.0);
    const double omega = std::sqrt(
        9.81 / (PlainMomentum(scene.model, scene.data->kinematics, goal->robot).centre.z() -
                goal->p_WTarget.z()));
    const Vector3 off =
        omega * (rateAlong(scene, a, xi) - goal->v_WTarget + goal->rate * (now - goal->p_WTarget));
    const double expected = 0.5 * goal->weight * off.squaredNorm();
    EXPECT_SMALL(GoalCheck(scene, *goal).value(a) / expected - 1.0, kDifference) << seed;
  }
}

TEST(BalanceGoals, WithoutAPendulumThereIsNoCapturePoint) {
  const Scene scene = looseScene(1);
  const gdd::CapturePoint goal(scene.model, scene.model.bodies[1].robot, Vector3(0.0, 0.0, 50.0));
  EXPECT_FALSE(goal.position({scene.model, scene.state, *scene.data}));
  EXPECT_EQ(GoalCheck(scene, goal).hessian().norm(), 0.0);
}

// ---- What the humanoid does ---------------------------------------------------------------------

TEST(BalanceBehaviour, TheHumanoidShiftsItsWeight) {
  RobotScene r("humanoid");
  r.addPosture();
  // A nanometre above the ground, so that nothing touches it in the first step.
  r.state.q[2] += 1e-9;
  const int robot = gdd::drivenRobot(r.model);
  const auto centre = [&] {
    return PlainMomentum(r.model, kinematicsAt(r.model, r.state), robot).centre;
  };
  const Vector3 target = centre() + Vector3(0.0, 0.03, 0.0);
  auto goal = std::make_unique<gdd::CenterOfMass>(r.model, robot, target);
  goal->axes = {true, true, false};
  goal->weight = 1e5;
  goal->stiffness = 50.0;
  goal->damping = 15.0;
  r.controller.goals.push_back(std::move(goal));
  for (int i = 0; i < 1500; ++i) ASSERT_NE(r.step(), SolveStatus::notFinite);
  EXPECT_SMALL((centre() - target).head<2>().norm(), 0.01);
  EXPECT_GT(r.data.kinematics.X_WB[1].p.z(), 0.85) << "the pelvis is to stay up";
}

}  // namespace
}  // namespace softgauss::test

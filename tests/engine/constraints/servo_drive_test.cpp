// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/servo_drive.hpp"

#include <algorithm>
#include <cmath>

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

constexpr double kMass = 2.0;

/// A slide along x without gravity, and a servo.
Scene slide(const Servo& servo, double timestep = 0.002) {
  ModelBuilder builder("slide");
  builder.base = BaseKind::fixed;
  builder.options.gravity.setZero();
  builder.options.timestep = timestep;
  builder.link(emptyLink("world")).link(boxLink("box", kMass, {0.1, 0.1, 0.1}));
  JointSpec joint = jointSpec("x", JointType::prismatic, "world", "box", {}, Vector3::UnitX());
  joint.servo = servo;
  builder.joint(joint);
  return Scene(builder.build());
}

double energy(const Scene& s) {
  const double away = s.state.q[0] - s.model.dofs[0].servo.setPoint, v = s.state.v[0];
  return 0.5 * kMass * v * v + 0.5 * s.model.dofs[0].servo.kp * away * away;
}

// f = −K (q + t v⁺ − u) − B (v⁺ − u̇), by its own arithmetic.
TEST(ServoDrive, ForceIsThatOfTheStepsEnd) {
  const double h = 0.002, t = 0.001, q = 0.3, v = -0.7, u = 0.1, rate = 0.4, kp = 500, kd = 20;
  Scene s = slide({.kp = kp, .kd = kd}, h);
  s.state.q[0] = q;
  s.state.v[0] = v;
  s.input.setPoint = VectorX::Constant(1, u);
  s.input.setPointRate = VectorX::Constant(1, rate);
  s.stages();
  s.forward();
  const double f = s.data->constraints.servo.f[0], end = v + h * s.data->forward.a[0];
  EXPECT_SMALL(f + kp * (q + t * end - u) + kd * (end - rate), 1e-11);
  EXPECT_SMALL(s.data->forward.a[0] - f / kMass, 1e-12);
}

// A mass on a damped spring: the error is of first order, half of it with half the step.
TEST(ServoDrive, IsTheSpringAndDamperOfItsGains) {
  const double kp = 50.0, kd = 4.0, duration = 1.0;
  const double decay = kd / (2.0 * kMass), w = std::sqrt(kp / kMass - decay * decay);
  const double exact =
      -std::exp(-decay * duration) * (std::cos(w * duration) + decay / w * std::sin(w * duration));
  double last = 0.0;
  for (const double h : {0.008, 0.004, 0.002, 0.001}) {
    Scene s = slide({.kp = kp, .kd = kd, .setPoint = 1.0}, h);
    s.steps(static_cast<int>(std::lround(duration / h)));
    const double error = std::abs(s.state.q[0] - 1.0 - exact);
    EXPECT_LE(error, 2.0 * h);
    if (last > 0.0) {
      EXPECT_SMALL(last / error - 2.0, 0.1) << h;
    }
    last = error;
  }
}

// What a loop of the same gains does not: at 5 ms kp = 1e5 takes 1.1 radians a step of this mass.
TEST(ServoDrive, NeverGainsEnergyAtAnyGain) {
  for (const double h : {0.0005, 0.002, 0.005, 0.01})
    for (const double kp : {0.0, 1.0, 1e2, 1e4, 1e5, 1e8})
      for (const double kd : {0.0, 1.0, 1e2, 1e4}) {
        if (kp == 0.0 && kd == 0.0) continue;
        SCOPED_TRACE(testing::Message() << "h " << h << ", kp " << kp << ", kd " << kd);
        Scene s = slide({.kp = kp, .kd = kd, .setPoint = 0.5}, h);
        s.state.v[0] = 1.0;
        const double start = energy(s);
        double most = 0.0;
        for (double time = 0.0; time < 2.0; time += h) {
          s.step();
          most = std::max(most, energy(s));
        }
        EXPECT_LE(most, start * (1.0 + 1e-12));
        if (kp >= 1e5) {
          EXPECT_SMALL(energy(s) / start, 1e-2);
        }
      }
}

// Under a load it rests where its spring bears it: load/kp away, whatever the step and the
// integrator.
TEST(ServoDrive, RestsWhereItsSpringBearsTheLoad) {
  for (const IntegratorName& integrator : kIntegratorNames)
    for (const double h : {0.001, 0.005})
      for (const double kp : {1e3, 1e5}) {
        SCOPED_TRACE(testing::Message() << integrator.name << ", h " << h << ", kp " << kp);
        Scene s = slide({.kp = kp, .kd = 2.0 * std::sqrt(kp * kMass), .setPoint = 0.2}, h);
        s.model.options.integrator = integrator.integrator;
        s.input.tau[0] = 30.0;
        s.steps(static_cast<int>(2.0 / h));
        EXPECT_SMALL(s.state.v[0], 1e-9);
        EXPECT_SMALL(s.state.q[0] - 0.2 - 30.0 / kp, 1e-9);
      }
}

// A user's loop that is closed once a step multiplies v by 1 − h kd/m = −4; the row holds.
TEST(ServoDrive, HoldsWhereALoopClosedOnceAStepDiverges) {
  const double kp = 100.0, kd = 5.0, h = 0.001, mass = 1e-3;
  ModelBuilder builder("light");
  builder.base = BaseKind::fixed;
  builder.options.timestep = h;
  builder.link(emptyLink("world")).link(boxLink("box", mass, {0.1, 0.1, 0.1}));
  builder.joint(jointSpec("x", JointType::prismatic, "world", "box", {}, Vector3::UnitX()));
  Scene loop(builder.build()), servo(builder.build());
  servo.model.dofs[0].servo = {.kp = kp, .kd = kd};
  for (Scene* s : {&loop, &servo}) s->state.q[0] = 0.1;
  for (int i = 0; i < 1000; ++i) {
    loop.input.tau[0] = -kp * loop.state.q[0] - kd * loop.state.v[0];
    if (std::abs(loop.state.v[0]) < 1e100) loop.step();
    servo.step();
    ASSERT_LE(std::abs(servo.state.q[0]), 0.1);
  }
  EXPECT_GE(std::abs(loop.state.v[0]), 1e100);
  // Overdamped, it creeps back at the rate kp/kd; the error of its first order is below a tenth.
  EXPECT_SMALL(servo.state.q[0] / (0.1 * std::exp(-kp / kd)) - 1.0, 0.1);
}

TEST(ServoDrive, ForceIsLimited) {
  for (const double sign : {-1.0, 1.0}) {
    Scene s = slide({.kp = 1e4, .kd = 10.0, .effort = 3.0, .setPoint = 100.0 * sign});
    s.stages();
    s.forward();
    EXPECT_EQ(s.data->constraints.servo.f[0], 3.0 * sign);
    EXPECT_SMALL(s.data->forward.a[0] - 3.0 * sign / kMass, 1e-15);
  }
}

// Told where to be and how fast that moves, it follows a line without lag; a velocity servo comes
// to its rate and keeps it.
TEST(ServoDrive, FollowsWhatMovesEvenly) {
  for (const double kp : {0.0, 400.0}) {
    Scene s = slide({.kp = kp, .kd = 60.0});
    for (int i = 0; i < 2000; ++i) {
      s.input.setPoint = VectorX::Constant(1, 0.3 * (i + 1) * s.model.options.timestep);
      s.input.setPointRate = VectorX::Constant(1, 0.3);
      s.step();
    }
    EXPECT_SMALL(s.state.v[0] - 0.3, 1e-12);
    if (kp > 0.0) {
      EXPECT_SMALL(s.state.q[0] - s.input.setPoint[0], 1e-12);
    }
  }
}

// The set point that is told for a force makes that force.
TEST(ServoDrive, SetPointOfAForceMakesIt) {
  const Servo servo{.kp = 300.0, .kd = 15.0};
  Scene forced = slide({}), told = slide(servo);
  for (int i = 0; i < 200; ++i) {
    forced.input.tau[0] = 8.0 * std::sin(0.05 * i);
    forced.step();
    told.input.setPoint = VectorX::Constant(
        1, setPointOf(servo, forced.state.q[0], forced.state.v[0], forced.input.tau[0]));
    told.step();
    EXPECT_SMALL(told.state.q[0] - forced.state.q[0], 1e-12);
    EXPECT_SMALL(told.data->constraints.servo.f[0] - forced.input.tau[0], 1e-9);
  }
}

// Goals choose the forces of the trees that they control.
TEST(ServoDrive, HasNoRowWhereAControlActs) {
  Scene s = slide({.kp = 300.0, .setPoint = 1.0});
  s.stages();
  EXPECT_EQ(s.data->constraints.servo.rowCount(), 1);
  s.input.controlled = allTrees(s.model);
  s.stages();
  EXPECT_EQ(s.data->constraints.servo.rowCount(), 0);
  s.input.controlled.clear();
  s.model.options.effects.remove(Effect::actuation);
  s.stages();
  EXPECT_EQ(s.data->constraints.servo.rowCount(), 0);
}

TEST(ServoDrive, RefusesWhatIsNone) {
  const auto refused = [](const Servo& servo, const std::string& what) {
    try {
      slide(servo);
      ADD_FAILURE() << what;
    } catch (const ModelError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  refused({.kp = -1.0}, "kp is -1, expected 0 or more");
  refused({.kp = 1.0, .kd = kInfinity}, "kd is inf");
  refused({.kp = 1.0, .effort = 0.0}, "effort is 0, expected more than 0");
  refused({.kp = 1.0, .setPoint = std::nan("")}, "set point is not finite");
  Scene s = slide({.kp = 1.0});
  s.input.setPoint = VectorX::Zero(2);
  EXPECT_EQ(s.step(), SolveStatus::badInput);
  s.input.setPoint = VectorX::Constant(1, std::nan(""));
  EXPECT_EQ(s.step(), SolveStatus::notFinite);
}

}  // namespace
}  // namespace softgauss::test

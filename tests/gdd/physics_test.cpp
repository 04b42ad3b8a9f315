// SPDX-License-Identifier: Apache-2.0
/// What a step of goal directed dynamics promises about physics: the motion is what the control
/// causes, the control is what the actuators can do, and the contact forces are those that act.

#include "tests/gdd/gdd_scene.hpp"
#include "tests/gdd/robot_scene.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// Forces of all rows at the acceleration a.
VectorX rowForces(const Model& model, const VectorX& a, Data& data) {
  VectorX unused(model.nv);
  inverseDynamics(model, a, data, unused);
  VectorX f(data.constraints.rowCount());
  int row = 0;
  data.constraints.visit([&](const auto& c) {
    for (const double force : c.f) f[row++] = force;
  });
  return f;
}

struct Watch {
  double violation = 0.0;  ///< largest |g(q, v, a) − (u, 0)|
  double forceGap = 0.0;   ///< assumed against acting forces, where the report says converged
  int steps = 0, converged = 0, kinks = 0, unfinished = 0, saturated = 0;

  void stepOf(RobotScene& r) {
    const State before = r.state;
    ASSERT_NE(r.step(), SolveStatus::notFinite);
    ++steps;
    EXPECT_TRUE(r.controlsAllowed()) << "at " << before.time << " s";
    VectorX g(r.model.nv);
    inverseDynamics(r.model, r.data.forward.a, r.data, g);
    violation = std::max(violation, (g - r.data.forces.tau).cwiseAbs().maxCoeff());
    for (int i = 0; i < r.model.nv; ++i)
      saturated +=
          r.model.dofs[i].actuated && (r.controller.control[i] == r.controller.limits.lower[i] ||
                                       r.controller.control[i] == r.controller.limits.upper[i]);
    const gdd::GddStatus status = r.controller.report.status;
    converged += status == gdd::GddStatus::converged;
    kinks += status == gdd::GddStatus::nonsmoothMinimum;
    unfinished += status == gdd::GddStatus::iterationLimit;
    if (status == gdd::GddStatus::iterationLimit || r.data.constraints.rowCount() == 0) return;
    const VectorX assumed = rowForces(r.model, r.controller.acceleration(), r.data);
    const VectorX acting = rowForces(r.model, r.data.forward.a, r.data);
    const double scale = std::max(1.0, acting.cwiseAbs().maxCoeff());
    forceGap = std::max(forceGap, (assumed - acting).cwiseAbs().maxCoeff() / scale);
  }

  void check() const {
    // Newton's tolerance of 1e-12 in units of √M_ii, times the forces at work.
    EXPECT_SMALL(violation, 1e-8);
    EXPECT_SMALL(forceGap, 1e-6);
    EXPECT_LE(unfinished, steps / 20);
  }
};

TEST(GddPhysics, HumanoidMovesAsItsControlsMakeIt) {
  RobotScene r("humanoid");
  r.addReach("right_hand", {0.45, -0.25, 1.10});
  r.addDamping();
  Watch watch;
  for (int i = 0; i < 700; ++i) watch.stepOf(r);
  watch.check();
  EXPECT_GT(watch.converged, 0);
}

TEST(GddPhysics, HandMovesAsItsControlsMakeIt) {
  RobotScene r("hand");
  r.addReach("index_tip", {0.15, 0.05, 0.08});
  r.addDamping();
  Watch watch;
  for (int i = 0; i < 500; ++i) watch.stepOf(r);
  watch.check();
}

TEST(GddPhysics, ArmMovesAsItsControlsMakeIt) {
  RobotScene r("arm");
  r.addReach("hand", {0.5, 0.3, 0.5});
  r.addDamping();
  Watch watch;
  for (int i = 0; i < 500; ++i) watch.stepOf(r);
  watch.check();
}

// Goals that no actuator can serve: the box holds exactly, and often.
TEST(GddPhysics, SaturatedControlsStayInTheirBox) {
  RobotScene r("humanoid");
  r.addReach("right_hand", {3.0, 0.0, 3.0}).weight = 1e5;
  r.addDamping();
  Watch watch;
  for (int i = 0; i < 300; ++i) watch.stepOf(r);
  EXPECT_SMALL(watch.violation, 1e-8);
  EXPECT_GT(watch.saturated, 300);
}

// The box of the controller, not that of the model, is what holds.
TEST(GddPhysics, ChangedBoxIsObeyed) {
  RobotScene r("arm");
  r.addReach("hand", {0.5, 0.3, 0.5});
  r.controller.limits.lower.setConstant(-3.0);
  r.controller.limits.upper.setConstant(2.0);
  for (int i = 0; i < 50; ++i) {
    ASSERT_EQ(r.step(), SolveStatus::converged);
    EXPECT_LE(r.controller.control.maxCoeff(), 2.0);
    EXPECT_GE(r.controller.control.minCoeff(), -3.0);
    EXPECT_EQ(r.controller.control, r.data.forces.tau);
  }
}

// A disturbance acts besides the control, and the control answers it.
TEST(GddPhysics, DisturbanceIsPartOfTheProblemNotOfTheControl) {
  RobotScene r("arm");
  r.addPosture();
  r.input.tau = VectorX::Constant(r.model.nv, 4.0);
  ASSERT_EQ(r.step(), SolveStatus::converged);
  VectorX g(r.model.nv);
  inverseDynamics(r.model, r.data.forward.a, r.data, g);
  EXPECT_APPROX(g, r.controller.control, 1e-9);

  RobotScene calm("arm");
  calm.addPosture();
  ASSERT_EQ(calm.step(), SolveStatus::converged);
  // g = u with c − τ in the place of c: the same acceleration wants a control less by about τ.
  const VectorX change = calm.controller.control - r.controller.control;
  EXPECT_GT(change.minCoeff(), 3.9);
  EXPECT_LT(change.maxCoeff(), 4.1);
}

// With no actuator at all the control is zero and the robot falls as it would.
TEST(GddPhysics, WithoutActuatorsMotionIsPassive) {
  for (const bool byEffect : {true, false}) {
    Scene passive = randomScene(5, 6);
    passive.input = {};
    passive.input.tau = VectorX::Zero(passive.model.nv);
    if (byEffect) passive.model.options.effects.remove(Effect::actuation);
    State state = passive.state;
    Data data(passive.model);
    gdd::GoalDirectedController controller(passive.model);
    if (!byEffect)
      controller.limits.lower = controller.limits.upper = VectorX::Zero(passive.model.nv);
    controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
    for (int i = 0; i < 20; ++i) {
      ASSERT_EQ(controller.step(passive.model, passive.input, state, data, passive.contacts.get()),
                SolveStatus::converged);
      EXPECT_EQ(controller.control.cwiseAbs().maxCoeff(), 0.0);
      ASSERT_EQ(passive.step(), SolveStatus::converged);
    }
    // Both solve the same convex problem, from other guesses.
    EXPECT_APPROX(state.v, passive.state.v, 1e-8);
    EXPECT_APPROX(state.q, passive.state.q, 1e-8);
  }
}

}  // namespace
}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0
/// Velocity limits and range ends: what a controller keeps, and what it leaves as it was.

#include "tests/gdd/robot_scene.hpp"

namespace softgauss::test {
namespace {

/// The arm with a posture to take.
struct Arm : RobotScene {
  gdd::Posture& posture;

  explicit Arm(double speedLimit) : RobotScene("arm"), posture(addPosture()) {
    posture.weight = 1000.0;
    for (Dof& dof : model.dofs) dof.velocityLimit = speedLimit;
  }
  int dof(const std::string& joint) const { return model.bodies[model.findJoint(joint)].v; }
  double& target(const std::string& joint) {
    return posture.q[model.bodies[model.findJoint(joint)].q];
  }
  void advance() { ASSERT_EQ(step(), SolveStatus::converged); }
};

/// Largest |v| of a joint while the arm swings its shoulder over by 1.5 rad [rad/s].
double fastest(Arm& arm) {
  arm.target("shoulder_yaw") = 1.5;
  double most = 0.0;
  while (arm.state.time < 2.0 && !testing::Test::HasFailure()) {
    arm.advance();
    most = std::max(most, arm.state.v.cwiseAbs().maxCoeff());
  }
  return most;
}

/// The elbow's speed as it arrives at the end of its range, sent 0.5 rad beyond it [rad/s].
double arrival(Arm& arm) {
  const JointRange* range = nullptr;
  for (const JointRange& r : arm.model.ranges)
    if (r.body == arm.model.findJoint("elbow_pitch")) range = &r;
  const int q = arm.model.bodies[range->body].q, v = arm.dof("elbow_pitch");
  arm.target("elbow_pitch") = range->upper + 0.5;
  while (arm.state.time < 4.0 && !testing::Test::HasFailure()) {
    arm.advance();
    if (arm.state.q[q] >= range->upper - 1e-3) return arm.state.v[v];
  }
  ADD_FAILURE() << "the elbow is at " << arm.state.q[q] << " of " << range->upper;
  return kInfinity;
}

}  // namespace

// In a step a joint gains at most what brings it from u/2 towards u; what goals of weight 1000
// outweigh of a cost of weight 1e6 is a thousandth.
TEST(MotionLimits, JointsStayBelowTheirVelocityLimit) {
  constexpr double kLimit = 1.0;  // [rad/s]
  Arm free(kLimit), limited(kLimit);
  limited.controller.motionLimits.emplace();
  EXPECT_GT(fastest(free), 1.3 * kLimit);
  EXPECT_LT(fastest(limited), 1.02 * kLimit);
  const int shoulder = limited.model.bodies[limited.model.findJoint("shoulder_yaw")].q;
  EXPECT_NEAR(limited.state.q[shoulder], 1.5, 0.05);  // and arrives
}

TEST(MotionLimits, NoJointArrivesAtTheEndOfItsRangeAtSpeed) {
  Arm free(kInfinity), limited(kInfinity);
  limited.controller.motionLimits.emplace();
  const double freely = arrival(free);
  EXPECT_GT(freely, 0.5);
  EXPECT_LT(arrival(limited), 0.2 * freely);
}

TEST(MotionLimits, LeaveTheBitsOfWhatIsSlow) {
  Arm free(10.0), limited(10.0);
  limited.controller.motionLimits.emplace();
  fastest(free);
  fastest(limited);
  EXPECT_EQ(free.state.q, limited.state.q);
  EXPECT_EQ(free.state.v, limited.state.v);
}

// A wish that no bound on the acceleration allows: a joint that is ten times too fast brakes with
// what its motor has, and the step is solved.
TEST(MotionLimits, AreACostThatTorqueLimitsMayOutweigh) {
  Arm arm(0.5);
  arm.controller.motionLimits.emplace();
  const int shoulder = arm.dof("shoulder_yaw");
  arm.controller.limits.lower[shoulder] = -5.0;  // [N m]
  arm.state.v[shoulder] = 5.0;
  arm.advance();
  EXPECT_EQ(arm.controller.control[shoulder], -5.0);
  while (arm.state.time < 1.0 && !testing::Test::HasFailure()) arm.advance();
  EXPECT_LT(std::abs(arm.state.v[shoulder]), 0.51);
}

}  // namespace softgauss::test

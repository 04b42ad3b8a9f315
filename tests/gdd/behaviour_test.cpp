// SPDX-License-Identifier: Apache-2.0
/// What the robots do: stand and reach, reach, point. Greedy minimisation of simple costs.

#include "tests/gdd/robot_scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

TEST(GddBehaviour, HumanoidStandsAndReachesForTenSeconds) {
  RobotScene r("humanoid");
  r.addPosture();
  const Vector3 target(0.45, -0.25, 1.10);
  gdd::Reach& reach = r.addReach("right_hand", target);
  reach.weight = 1e5;
  reach.stiffness = 50.0;
  reach.damping = 15.0;
  double lowest = kInfinity;
  for (int i = 0; i < 5000; ++i) {
    ASSERT_NE(r.step(), SolveStatus::notFinite) << "at " << r.state.time << " s";
    ASSERT_TRUE(r.controlsAllowed()) << "at " << r.state.time << " s";
    lowest = std::min(lowest, r.data.kinematics.X_WB[1].p.z());
  }
  EXPECT_SMALL((r.position("right_hand") - target).norm(), 0.01);
  EXPECT_GT(lowest, 0.85) << "the pelvis is to stay up";
  EXPECT_LT(r.state.v.cwiseAbs().maxCoeff(), 0.1) << "it is to come to rest";
}

TEST(GddBehaviour, ArmClosesMostOfTheDistance) {
  RobotScene r("arm");
  const Vector3 target(0.5, 0.3, 0.5);
  r.addReach("hand", target);
  r.addDamping();
  const double before = (r.position("hand") - target).norm();
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(r.step(), SolveStatus::converged);
  const double after = (r.position("hand") - target).norm();
  EXPECT_LT(after, 0.2 * before);
}

// Dry friction in every joint: each solve ends with its certificate, and nothing drives by
// friction.
TEST(GddBehaviour, ArmWithDryFrictionClosesMostOfTheDistance) {
  RobotScene r("arm");
  for (Dof& dof : r.model.dofs) dof.dryFriction = 2.0;
  const Vector3 target(0.5, 0.3, 0.5);
  r.addReach("hand", target);
  r.addDamping();
  const double before = (r.position("hand") - target).norm();
  int kinks = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(r.step(), SolveStatus::converged);
    const gdd::GddStatus status = r.controller.report.status;
    kinks += status == gdd::GddStatus::nonsmoothMinimum;
    EXPECT_TRUE(status == gdd::GddStatus::nonsmoothMinimum || status == gdd::GddStatus::converged)
        << i;
    EXPECT_SMALL(r.controller.report.stationarity, 1e-6);
    ASSERT_TRUE(r.controlsAllowed());
  }
  EXPECT_LT((r.position("hand") - target).norm(), 0.2 * before);
  EXPECT_GT(kinks, 0) << "joints at the point of slipping";
}

// The heavier the goal, the less of it is left when the arm has come to rest.
TEST(GddBehaviour, HeavierGoalsLeaveLess) {
  double last = kInfinity;
  for (const double weight : {50.0, 500.0, 5000.0}) {
    RobotScene r("arm");
    const Vector3 target(0.5, 0.3, 0.5);
    r.controller.controlCost = gdd::ControlCost::total;
    r.addReach("hand", target).weight = weight;
    r.addDamping();
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(r.step(), SolveStatus::converged);
    const double left = (r.position("hand") - target).norm();
    EXPECT_LT(left, last) << "weight " << weight;
    last = left;
  }
}

// A hand on its back of a forearm that nothing drives: the index finger goes to the thumb's side.
TEST(GddBehaviour, LyingHandPointsToTheThumb) {
  RobotScene r("hand");
  const Vector3 thumb = r.position("thumb_tip"), index = r.position("index_tip");
  const double side = thumb.y() > index.y() ? 1.0 : -1.0;
  const Vector3 target = index + Vector3(-0.01, 0.02 * side, 0.02);
  r.addReach("index_tip", target);
  r.addDamping();
  for (int i = 0; i < 500; ++i) {
    ASSERT_NE(r.step(), SolveStatus::notFinite);
    ASSERT_TRUE(r.controlsAllowed());
  }
  EXPECT_LT((r.position("index_tip") - target).norm(), 0.5 * (index - target).norm());
}

}  // namespace
}  // namespace softgauss::test

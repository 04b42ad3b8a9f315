// SPDX-License-Identifier: Apache-2.0
/// The kinds of goal beyond reach, posture and damping: what their keys mean, and what is refused.

#include <gtest/gtest.h>

#include "sample_goals.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/dynamics/energy.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/goals.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

using items::errorOfItem;
using items::readOne;

TEST(GoalTimesInFiles, AreOfEveryKind) {
  const auto goal = readOne<gdd::VirtualDamping>("damping: {start: -1, end: 2.5}");
  EXPECT_EQ(goal->startTime, -1.0);
  EXPECT_EQ(goal->endTime, 2.5);
  const auto forever = readOne<gdd::VirtualDamping>("damping: {}");
  EXPECT_TRUE(forever->actsAt(-1e300) && forever->actsAt(1e300));
  EXPECT_EQ(errorOfItem("damping: {start: 1, end: 1}"),
            "'damping': key 'end': found 1 s, expected a time after the start at 1 s");
  EXPECT_EQ(errorOfItem("damping: {end: .inf}"),
            "'damping': key 'end': found '.inf', expected a finite number");
}

// The largest numbers that a file may hold overflow nothing: each kind, each of its numbers.
TEST(GoalNumbersInFiles, AtTheirLargestKeepStepsFinite) {
  const std::string items[] = {
      "reach: {link: arm, target: [1e12, 1e12, -1e12], point: [0, 1e12, 0], weight: 1e12,"
      " stiffness: 1e12, damping: 1e12}",
      "reach: {link: arm, target: [0, 1e12, 0], rpy: [1e12, 0, 1e12], rotation_weight: 1e12,"
      " metric: consistent, minimum_jerk: {duration: 1e-6, start: -1e-7}}",
      "link_acceleration: {link: arm, linear: [1e12, 0, 1e12], angular: [1e12, 0, 0],"
      " weight: 1e12}",
      "look_at: {link: arm, target: [1e12, 1, 2], axis: [1e12, 1e12, 0], weight: 1e12,"
      " stiffness: 1e12, damping: 1e12}",
      "look_at: {link: arm, target: [1, 1, 2], axis: [1e-300, 1e-300, 0]}",
      "hold: {link: arm, point: [1e12, 0, 0], weight: 1e12, rate: 1e12}",
      "posture: {weight: 1e12, stiffness: 1e12, damping: 1e12, joints: {shoulder: 1e12}}",
      "reach: {link: arm, stiffness: 1e12, damping: 1e12, trajectory: {times: [0, 1e-6, 1e12],"
      " points: [[1e12, 0, 0], [-1e12, 0, 0], [0, 1e12, 0]]}}",
      "reach: {link: arm, trajectory: {circle: {center: [0, 0, 1e12], radius: 1e12,"
      " frequency: 1e12, normal: [1e-300, 1e-300, 0], phase: 1e12}}}",
      "joint_posture: {weight: 1e12, trajectory: {times: [-1e-6, 0, 1e-6],"
      " joints: {shoulder: [1e12, -1e12, 1e12]}, interpolation: natural_spline}}",
      "joint_velocity: {joints: {shoulder: 1e12}, weight: 1e12, rate: 1e12}",
      "damping: {weight: 1e12, rate: 1e12}",
      "center_of_mass: {target: [1e12, 0, 0], weight: 1e12, stiffness: 1e12, damping: 1e12}",
      "momentum: {linear: [1e12, 0, 0], linear_weight: 1e12, rate: 1e12}",
      "capture_point: {target: [1e12, 0, 0], weight: 1e12, rate: 1e12}"};
  for (const std::string& item : items) {
    gdd::GoalDirectedController controller(sampleModel());
    controller.goals = items::readItems("  - " + item + "\n");
    Data data(sampleModel());
    State state = sampleState();
    EXPECT_NE(controller.step(sampleModel(), {}, state, data, nullptr), SolveStatus::notFinite)
        << item;
  }
}

TEST(LinkAccelerationInFiles, ArrivesWithItsValues) {
  const auto goal = readOne<gdd::LinkAcceleration>(
      "link_acceleration: {link: arm, linear: [1, 2, 3], angular: [4, 5, 6], point: [7, 8, 9],"
      " weight: 10, rotation_weight: 11, metric: consistent}");
  EXPECT_EQ(goal->link, "arm");
  EXPECT_EQ(goal->linear, Vector3(1, 2, 3));
  ASSERT_TRUE(goal->angular);
  EXPECT_EQ(*goal->angular, Vector3(4, 5, 6));
  EXPECT_EQ(goal->p_FP, Vector3(7, 8, 9));
  EXPECT_EQ(goal->weight, 10.0);
  EXPECT_EQ(goal->rotationWeight, 11.0);
  EXPECT_EQ(goal->metric, gdd::LinkMetric::consistent);
  EXPECT_FALSE(
      readOne<gdd::LinkAcceleration>("link_acceleration: {link: arm, linear: [1, 2, 3]}")->angular);
  EXPECT_EQ(
      errorOfItem("link_acceleration: {link: arm, linear: [1, 2, 3], rotation_weight: 1}"),
      "'link_acceleration': key 'rotation_weight': found without a rotation, expected angular "
      "beside it");
}

TEST(DampingInFiles, HasTwoMetrics) {
  EXPECT_EQ(readOne<gdd::VirtualDamping>("damping: {}")->metric, gdd::DampingMetric::inertia);
  EXPECT_EQ(readOne<gdd::VirtualDamping>("damping: {metric: inverse_inertia}")->metric,
            gdd::DampingMetric::inverseInertia);
  EXPECT_EQ(errorOfItem("damping: {metric: R}"),
            "'damping': key 'metric': found 'R', expected one of inertia, inverse_inertia");
}

TEST(JointGoalsInFiles, ArriveWithTheirValues) {
  const auto posture = readOne<gdd::JointPosture>(
      "joint_posture: {joints: {shoulder: 0.8}, weight: 1, stiffness: 2, damping: 3}");
  ASSERT_EQ(posture->targets.size(), 1u);
  EXPECT_EQ(posture->targets[0].body, sampleModel().findJoint("shoulder"));
  EXPECT_EQ(posture->targets[0].value, 0.8);
  EXPECT_EQ(posture->weight, 1.0);
  EXPECT_EQ(posture->stiffness, 2.0);
  EXPECT_EQ(posture->damping, 3.0);
  const auto acceleration =
      readOne<gdd::JointAcceleration>("acceleration: {joints: {shoulder: -4}, weight: 5}");
  ASSERT_EQ(acceleration->targets.size(), 1u);
  EXPECT_EQ(acceleration->targets[0].value, -4.0);
  EXPECT_EQ(acceleration->weight, 5.0);
  EXPECT_EQ(readOne<gdd::JointAcceleration>("acceleration: {joints: {shoulder: 0}}")->weight,
            gdd::JointAcceleration().weight);
}

TEST(JointGoalsInFiles, BadOnesAreRefused) {
  EXPECT_EQ(errorOfItem("acceleration: {}"),
            "'acceleration': key 'joints': found no such key, expected a map of joints, {joint: "
            "number}");
  EXPECT_EQ(errorOfItem("joint_posture: {joints: {}}"),
            "'joint_posture': key 'joints': found an empty map, expected at least one joint");
  EXPECT_EQ(errorOfItem("acceleration: {joints: {sholder: 1}}"),
            "'acceleration': key 'joints.sholder': found an unknown joint, expected one of model "
            "'sample', did you mean 'shoulder'? there are: shoulder");
  EXPECT_EQ(errorOfItem("acceleration: {joints: {shoulder: 1}, weight: -1}"),
            "'acceleration': key 'weight': found '-1', expected a finite number >= 0");
  EXPECT_EQ(errorOfItem("acceleration: {joints: {shoulder: 1}, stiffness: 1}"),
            "'acceleration': key 'stiffness': found an unknown key, expected one of joints, "
            "weight, start, end");
}

TEST(LinkGoalsInFiles, APoseArrivesWithItsValues) {
  const auto pose = readOne<gdd::Reach>(
      "reach: {link: arm, target: [1, 2, 3], rpy: [0.1, 0.2, 0.3], weight: 5, rotation_weight: 6,"
      " minimum_jerk: {}}");
  ASSERT_TRUE(pose->R_WTarget);
  EXPECT_EQ(*pose->R_WTarget, rpyRotation(Vector3(0.1, 0.2, 0.3)));
  EXPECT_EQ(pose->weight, 5.0);
  EXPECT_EQ(pose->rotationWeight, 6.0);
  EXPECT_EQ(pose->metric, gdd::LinkMetric::euclidean);
  Kinematics k(sampleModel());
  computeKinematics(sampleModel(), sampleState(), k);
  EXPECT_EQ(pose->minimumJerk->R_start, framePose(sampleModel(), k, pose->frame).R);

  const auto turned = readOne<gdd::Reach>(
      "reach: {link: arm, target: [1, 2, 3], quaternion: [0, 0, 0, 1], weight: 5}");
  EXPECT_EQ(*turned->R_WTarget, Vector3(-1.0, -1.0, 1.0).asDiagonal().toDenseMatrix());
  EXPECT_EQ(turned->rotationWeight, 0.05);

  const auto consistent =
      readOne<gdd::Reach>("reach: {link: arm, target: [1, 2, 3], metric: consistent}");
  EXPECT_EQ(consistent->metric, gdd::LinkMetric::consistent);
  EXPECT_EQ(consistent->weight, 1000.0);
  EXPECT_EQ(consistent->rotationWeight, 1000.0);
}

TEST(LinkGoalsInFiles, LookAtAndHoldArriveWithTheirValues) {
  const auto look = readOne<gdd::LookAt>(
      "look_at: {link: arm, target: [1, 2, 3], axis: [0, 0, 2], point: [4, 5, 6], weight: 7,"
      " stiffness: 8, damping: 9}");
  EXPECT_EQ(look->axis_F, Vector3::UnitZ());
  EXPECT_EQ(look->p_WTarget, Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(look->p_FP, Vector3(4.0, 5.0, 6.0));
  EXPECT_EQ(look->weight, 7.0);
  EXPECT_EQ(look->stiffness, 8.0);
  EXPECT_EQ(look->damping, 9.0);
  EXPECT_EQ(readOne<gdd::LookAt>("look_at: {link: arm, target: [1, 2, 3]}")->axis_F,
            Vector3::UnitX());

  const auto whole = readOne<gdd::Hold>("hold: {link: arm, weight: 4, rate: 3}");
  EXPECT_TRUE(whole->wholeLink);
  EXPECT_EQ(whole->weight, 4.0);
  EXPECT_EQ(whole->rotationWeight, 0.04);
  EXPECT_EQ(whole->rate, 3.0);
  const auto point = readOne<gdd::Hold>("hold: {link: arm, point: [1, 0, 0]}");
  EXPECT_FALSE(point->wholeLink);
  EXPECT_EQ(point->p_FP, Vector3::UnitX());
}

TEST(LinkGoalsInFiles, BadOnesAreRefused) {
  const std::string reach = "reach: {link: arm, target: [1, 2, 3], ";
  EXPECT_EQ(errorOfItem(reach + "rpy: [0, 0, 0], quaternion: [1, 0, 0, 0]}"),
            "'reach': key 'quaternion': found beside rpy in line 2, expected one of them");
  EXPECT_EQ(errorOfItem(reach + "quaternion: [1, 1, 0, 0]}"),
            "'reach': key 'quaternion': found a list of 4, expected four numbers [w, x, y, z] of "
            "length 1");
  EXPECT_EQ(errorOfItem(reach + "rotation_weight: 1}"),
            "'reach': key 'rotation_weight': found without an orientation, expected rpy or "
            "quaternion beside it");
  EXPECT_EQ(errorOfItem(reach + "metric: consistant}").substr(0, 41),
            "'reach': key 'metric': found 'consistant'");
  EXPECT_EQ(errorOfItem("look_at: {link: arm, target: [1, 2, 3], axis: [0, 0, 0]}"),
            "'look_at': key 'axis': found a vector of length 0, expected a direction");
  EXPECT_EQ(errorOfItem("look_at: {link: arm}"),
            "'look_at': key 'target': found no such key, expected three numbers [x, y, z], or "
            "trajectory");
  EXPECT_EQ(errorOfItem("hold: {}"),
            "'hold': key 'link': found no such key, expected the name of a link");
  EXPECT_EQ(errorOfItem("hold: {link: arm, point: [0, 0, 0], rotation_weight: 1}"),
            "'hold': key 'rotation_weight': found beside a point, expected the whole link to be "
            "held");
}

TEST(BalanceGoalsInFiles, ArriveWithTheirValues) {
  const auto centre = readOne<gdd::CenterOfMass>(
      "center_of_mass: {link: arm, target: [1, 2, 3], axes: yx, weight: 4, stiffness: 5,"
      " damping: 6}");
  EXPECT_EQ(centre->p_WTarget, Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(centre->axes, (std::array<bool, 3>{true, true, false}));
  EXPECT_EQ(centre->weight, 4.0);
  EXPECT_EQ(centre->stiffness, 5.0);
  EXPECT_EQ(centre->damping, 6.0);
  // Without a target it is to stay where it is at first.
  Kinematics k(sampleModel());
  computeKinematics(sampleModel(), sampleState(), k);
  EXPECT_LT(
      (readOne<gdd::CenterOfMass>("center_of_mass: {}")->p_WTarget - centerOfMass(sampleModel(), k))
          .norm(),
      1e-14);

  const auto momentum = readOne<gdd::MomentumGoal>(
      "momentum: {linear: [1, 0, 0], angular: [0, 2, 0], linear_weight: 3, angular_weight: 4,"
      " rate: 5}");
  EXPECT_EQ(momentum->linear, Vector3(1.0, 0.0, 0.0));
  EXPECT_EQ(momentum->angular, Vector3(0.0, 2.0, 0.0));
  EXPECT_EQ(momentum->linearWeight, 3.0);
  EXPECT_EQ(momentum->angularWeight, 4.0);
  EXPECT_EQ(momentum->rate, 5.0);

  const auto capture =
      readOne<gdd::CapturePoint>("capture_point: {target: [1, 2, 0], weight: 3, rate: 4}");
  EXPECT_EQ(capture->p_WTarget, Vector3(1.0, 2.0, 0.0));
  EXPECT_EQ(capture->weight, 3.0);
  EXPECT_EQ(capture->rate, 4.0);
}

TEST(BalanceGoalsInFiles, BadOnesAreRefused) {
  for (const char* const axes : {"xx", "w", "xyzx", "''"})
    EXPECT_NE(errorOfItem(std::string("center_of_mass: {axes: ") + axes + "}").find("key 'axes'"),
              std::string::npos)
        << axes;
  EXPECT_EQ(errorOfItem("center_of_mass: {link: amr}"),
            "'center_of_mass': key 'link': found 'amr', expected a link of model 'sample', did "
            "you mean 'arm'? there are: base, arm");
  EXPECT_EQ(errorOfItem("momentum: {rate: -1}"),
            "'momentum': key 'rate': found '-1', expected a finite number >= 0");
  EXPECT_EQ(
      errorOfItem("capture_point: {}"),
      "'capture_point': key 'target': found no such key, expected three numbers [x, y, z], or "
      "trajectory");
}

TEST(EffortInFiles, IsOfTheActuatedJointsNamed) {
  const auto all = readOne<gdd::Effort>("effort: {weight: 3}");
  EXPECT_EQ(all->dofs, gdd::Effort::actuatedDofs(sampleModel()));
  EXPECT_EQ(all->weight, 3.0);
  const int dof =
      sampleModel().bodies[static_cast<std::size_t>(sampleModel().findJoint("shoulder"))].v;
  EXPECT_EQ(readOne<gdd::Effort>("effort: {joints: [shoulder]}")->dofs, std::vector<int>{dof});
  EXPECT_EQ(errorOfItem("effort: {joints: [sholder]}"),
            "'effort': key 'joints': found 'sholder', expected actuated joints of model 'sample', "
            "did you mean 'shoulder'?");
  EXPECT_EQ(errorOfItem("effort: {joints: [base]}").substr(0, 39),
            "'effort': key 'joints': found 'base', e");
  EXPECT_EQ(errorOfItem("effort: {joints: [shoulder, shoulder]}"),
            "'effort': key 'joints': found 'shoulder' twice, expected once");
  EXPECT_EQ(errorOfItem("effort: {joints: []}"),
            "'effort': key 'joints': found an empty list, expected at least one joint");
  EXPECT_EQ(errorOfItem("effort: {joints: [{a: 1}]}").substr(0, 36),
            "'effort': key 'joints': found a map,");
  EXPECT_EQ(errorOfItem("effort: {weight: -1}"),
            "'effort': key 'weight': found '-1', expected a finite number >= 0");
}

TEST(ContactGoalsInFiles, AForceArrivesWithItsValues) {
  const auto goal = readOne<gdd::ContactForce>(
      "contact_force: {link: arm, force: [1, 2, 3], axes: zx, by: base, weight: 4}");
  EXPECT_EQ(goal->link, "arm");
  EXPECT_EQ(goal->force, Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(goal->axes, (std::array<bool, 3>{true, false, true}));
  EXPECT_EQ(goal->weight, 4.0);
  // The geometries of the sample: that of base, that of arm.
  EXPECT_EQ(goal->contacts.on, (std::vector<char>{0, 1}));
  EXPECT_EQ(goal->contacts.by, (std::vector<char>{1, 0}));
  const auto plain = readOne<gdd::ContactForce>("contact_force: {link: arm, force: [1, 2, 3]}");
  EXPECT_EQ(plain->axes, (std::array<bool, 3>{true, true, true}));
  EXPECT_EQ(plain->weight, gdd::ContactForce(sampleModel(), "arm", Vector3::Zero()).weight);
  EXPECT_EQ(plain->contacts.by, (std::vector<char>{1, 0}));
  const auto ground =
      readOne<gdd::ContactForce>("contact_force: {link: arm, force: [1, 2, 3], by: world}");
  EXPECT_EQ(ground->contacts.by, (std::vector<char>{0, 0})) << "nothing of it is fixed";
}

TEST(ContactGoalsInFiles, APressureArrivesWithItsValues) {
  const auto goal =
      readOne<gdd::CenterOfPressure>("center_of_pressure: {target: [1, 2, 3], weight: 4}");
  EXPECT_EQ(goal->p_WTarget, Vector3(1.0, 2.0, 3.0));
  EXPECT_EQ(goal->n_W, Vector3::UnitZ());
  EXPECT_EQ(goal->weight, 4.0);
  EXPECT_EQ(goal->contacts.on, (std::vector<char>{1, 1}));
  const auto foot =
      readOne<gdd::CenterOfPressure>("center_of_pressure: {target: [1, 2, 3], links: [arm]}");
  EXPECT_EQ(foot->contacts.on, (std::vector<char>{0, 1}));
  EXPECT_EQ(foot->weight, gdd::CenterOfPressure(sampleModel(), 0, Vector3::Zero()).weight);
}

TEST(ContactGoalsInFiles, BadOnesAreRefused) {
  const std::string force = "contact_force: {link: arm, force: [1, 2, 3]";
  EXPECT_EQ(errorOfItem("contact_force: {link: arm}"),
            "'contact_force': key 'force': found no such key, expected three numbers [x, y, z]");
  EXPECT_EQ(errorOfItem("contact_force: {link: amr, force: [1, 2, 3]}"),
            "'contact_force': key 'link': found 'amr', expected a link of model 'sample', did you "
            "mean 'arm'? there are: base, arm");
  EXPECT_EQ(errorOfItem(force + ", by: bass}"),
            "'contact_force': key 'by': found 'bass', expected world or a link of model 'sample' "
            "with collision geometry, did you mean 'base'?");
  EXPECT_EQ(errorOfItem(force + ", by: arm}"),
            "'contact_force': key 'by': found the link itself, expected world or another link");
  EXPECT_EQ(errorOfItem(force + ", weight: -1}"),
            "'contact_force': key 'weight': found '-1', expected a finite number >= 0");
  EXPECT_NE(errorOfItem(force + ", axes: xx}").find("key 'axes'"), std::string::npos);
  const std::string pressure = "center_of_pressure: {target: [1, 2, 3]";
  EXPECT_EQ(errorOfItem("center_of_pressure: {}"),
            "'center_of_pressure': key 'target': found no such key, expected three numbers [x, y, "
            "z]");
  EXPECT_EQ(errorOfItem(pressure + ", links: [amr]}"),
            "'center_of_pressure': key 'links': found 'amr', expected links that move of model "
            "'sample' with collision geometry, did you mean 'arm'?");
  EXPECT_EQ(errorOfItem(pressure + ", links: [arm, arm]}"),
            "'center_of_pressure': key 'links': found 'arm' twice, expected once");
  EXPECT_EQ(errorOfItem(pressure + ", links: []}"),
            "'center_of_pressure': key 'links': found an empty list, expected at least one link");
  EXPECT_EQ(errorOfItem(pressure + ", link: arm, links: [arm]}"),
            "'center_of_pressure': key 'links': found beside link, expected one of them");
}

}  // namespace
}  // namespace softgauss::io

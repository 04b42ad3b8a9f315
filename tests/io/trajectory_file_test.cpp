// SPDX-License-Identifier: Apache-2.0
/// The key `trajectory` of goals in files, and joint_velocity: what they mean, and what is refused.

#include <gtest/gtest.h>

#include "sample_goals.hpp"

namespace softgauss::io {
namespace {

using items::errorOfItem;
using items::readOne;

TEST(TrajectoriesInFiles, CircleAndKnotsCountFromTheStartOfTheGoal) {
  const auto round = readOne<gdd::Reach>(
      "reach: {link: arm, start: 2, trajectory: {circle: {center: [1, 2, 3], radius: 0.5,"
      " frequency: 0.25, normal: [0, 0, 2], phase: 0}}}");
  ASSERT_TRUE(round->trajectory);
  EXPECT_LT((round->targetAt(2.0).p - Vector3(1.5, 2.0, 3.0)).norm(), 1e-14);
  EXPECT_LT((round->targetAt(3.0).p - Vector3(1.0, 2.5, 3.0)).norm(), 1e-14);
  const auto knots = readOne<gdd::LookAt>(
      "look_at: {link: arm, start: 2, trajectory: {times: [0, 1, 3], points: [[0, 0, 0],"
      " [1, 0, 0], [3, 0, 0]], interpolation: natural_spline, start: -1}}");
  EXPECT_LT((knots->targetAt(0.5).p - Vector3(1.5, 0.0, 0.0)).norm(), 1e-14);
  EXPECT_LT((knots->targetAt(0.5).v - Vector3(1.0, 0.0, 0.0)).norm(), 1e-14);
  const auto centre = readOne<gdd::CenterOfMass>(
      "center_of_mass: {link: arm, trajectory: {times: [0], points: [[1, 2, 3]]}}");
  EXPECT_EQ(centre->targetAt(5.0).p, Vector3(1, 2, 3));
  EXPECT_TRUE(readOne<gdd::CapturePoint>(
                  "capture_point: {link: arm, trajectory: {times: [0], points: [[1, 2, 0]]}}")
                  ->trajectory);
  const auto posture =
      readOne<gdd::Posture>("posture: {trajectory: {times: [0, 2], joints: {shoulder: [0, 1]}}}");
  ASSERT_EQ(posture->moving.size(), 1u);
  EXPECT_EQ(posture->moving[0].body, sampleModel().findJoint("shoulder"));
  EXPECT_NEAR(posture->moving[0].positionAt(1.0).p, 0.5, 1e-15);
  EXPECT_NEAR(posture->moving[0].positionAt(1.0).v, 0.9375, 1e-15);  // 15/8 of the mean
  const auto velocity =
      readOne<gdd::JointVelocity>("joint_velocity: {joints: {shoulder: 2}, weight: 3, rate: 4}");
  EXPECT_EQ(velocity->targets.at(0).value, 2.0);
  EXPECT_EQ(velocity->weight, 3.0);
  EXPECT_EQ(velocity->rate, 4.0);
}

TEST(TrajectoriesInFiles, AreReadFromTablesBesideTheFile) {
  const TempFolder folder;
  folder.write("hand.csv", "time_s,x,note,y,z\n0,0,a,1,2\n1,1,b,1,2\n2,2,c,1,2\n");
  folder.write("run.csv", "time_s,q:shoulder,v:shoulder\n0,0.5,0\n1,0.25,\n");
  const Goals goals =
      readGoals(folder.write("goals.yaml",
                             "goals:\n"
                             "  - reach: {link: arm, trajectory: {file: hand.csv, start: 1,"
                             " interpolation: natural_spline}}\n"
                             "  - joint_posture: {trajectory: {file: run.csv}}\n"),
                sampleModel(), sampleState());
  const auto& reach = dynamic_cast<gdd::Reach&>(*goals.at(0));
  EXPECT_LT((reach.targetAt(2.5).p - Vector3(1.5, 1.0, 2.0)).norm(), 1e-14);
  const auto& posture = dynamic_cast<gdd::JointPosture&>(*goals.at(1));
  ASSERT_EQ(posture.targets.size(), 1u);
  EXPECT_NEAR(posture.targets[0].positionAt(0.5).p, 0.375, 1e-15);
}

TEST(TrajectoriesInFiles, BadOnesAreRefused) {
  const std::string reach = "reach: {link: arm, trajectory: ", at = "'reach': key ";
  const auto error = [&](const std::string& text) { return errorOfItem(reach + text + "}"); };
  EXPECT_EQ(error("{}"), at + "'trajectory.circle': found no such key, expected one of circle, "
                              "points, file");
  EXPECT_EQ(error("{times: [0, 1], points: [[0, 0, 0]]}"),
            at + "'trajectory.points': found 1 point, expected 2, one for each of times");
  EXPECT_EQ(error("{points: [[0, 0, 0]]}"),
            at + "'trajectory.times': found no such key, expected a list of rising times [s]");
  EXPECT_EQ(error("{times: [1, 1], points: [[0, 0, 0], [1, 0, 0]]}"),
            at + "'trajectory.times': found 1 s after 1 s, expected times that rise by at least "
                 "1e-06 s");
  EXPECT_EQ(error("{times: [0, 1e-6], points: [[0, 0, 0], [1, 0, 0]], start: 1e12}"),
            at + "'trajectory.points': found times that are equal to rounding once they count "
                 "from 1000000000000 s, expected an earlier start");
  EXPECT_EQ(error("{times: [0], points: [[0, 0, 0]], file: x.csv}"),
            at + "'trajectory.file': found beside points, expected one of circle, points, file");
  EXPECT_EQ(error("{circle: {center: [0, 0, 0], radius: 0, frequency: 1}}"),
            at + "'trajectory.circle.radius': found '0', expected a finite number > 0");
  EXPECT_EQ(errorOfItem("reach: {link: arm, target: [0, 0, 0], trajectory: {}}"),
            at + "'trajectory': found beside target, expected one of target, trajectory");
  EXPECT_EQ(errorOfItem("joint_posture: {joints: {shoulder: 1}, trajectory: {times: [0], joints: "
                        "{shoulder: [1]}}}"),
            "'joint_posture': key 'joints': found beside trajectory, expected one of joints, "
            "trajectory");
  EXPECT_EQ(errorOfItem("posture: {trajectory: {times: [0, 1], joints: {shoulder: [1]}}}"),
            "'posture': key 'trajectory.joints.shoulder': found a list of 1, expected a list of 2 "
            "numbers, one for each of times");
}

}  // namespace
}  // namespace softgauss::io

// SPDX-License-Identifier: Apache-2.0
/// A file of goals as a whole: the keys beside the list, and lines that follow each other.

#include <gtest/gtest.h>

#include <algorithm>

#include "sample_goals.hpp"
#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/goals.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

/// What reading the text ends in, from the line on; nothing where it is read.
std::string errorOfFile(const std::string& text) {
  const TempFolder folder;
  const std::string file = folder.write("goals.yaml", text).string();
  try {
    readGoals(file, sampleModel(), sampleState());
  } catch (const ModelError& error) {
    return std::string(error.what()).substr(file.size() + 1);
  }
  return "";
}

// A scene file may be given as a file of goals. Its keys are then a scene's, and no others.
TEST(GoalsFile, OfASceneHasTheKeysOfAScene) {
  const std::string goals = "goals: [damping: {}]\n";
  EXPECT_EQ(errorOfFile("robots: []\ntimestep: 0.001\n" + goals), "");
  EXPECT_EQ(errorOfFile("objects: []\n" + goals), "");
  for (const std::string scene : {"robots: []\n", "objects: []\n"}) {
    const std::string error = errorOfFile(scene + "goalz: 3\n" + goals);
    EXPECT_TRUE(error.starts_with("2: key 'goalz': found an unknown key, expected one of "))
        << error;
    EXPECT_TRUE(error.ends_with(", did you mean 'goals'?")) << error;
  }
  EXPECT_EQ(errorOfFile("timestep: 0.001\n" + goals),
            "1: key 'timestep': found an unknown key, expected one of goals, control_cost");
}

/// The lines of the reaches of a file, in its order.
std::vector<gdd::MinimumJerk> linesOf(const std::string& items) {
  const TempFolder folder;
  std::vector<gdd::MinimumJerk> lines;
  for (const auto& goal :
       readGoals(folder.write("goals.yaml", "goals:\n" + items), sampleModel(), sampleState()))
    if (const auto* reach = dynamic_cast<const gdd::Reach*>(goal.get()))
      lines.push_back(reach->minimumJerk.value_or(gdd::MinimumJerk()));
  return lines;
}

TEST(LinesInFiles, BeginWithTheirGoals) {
  const auto lines = linesOf(
      "  - reach: {link: arm, target: [1, 2, 3], minimum_jerk: {}}\n"
      "  - reach: {link: arm, target: [1, 2, 3], start: -1, minimum_jerk: {}}\n"
      "  - reach: {link: arm, target: [1, 2, 3], start: 1.5, minimum_jerk: {duration: 2}}\n"
      "  - reach: {link: arm, target: [1, 2, 3], start: 1.5, minimum_jerk: {start: 0.5}}\n");
  EXPECT_EQ(lines.at(0).startTime, 0.0);
  EXPECT_EQ(lines.at(1).startTime, 0.0);
  EXPECT_EQ(lines.at(2).startTime, 1.5);
  EXPECT_EQ(lines.at(3).startTime, 0.5);
}

// From target to target of one point, in the order of their times; other points are their own.
TEST(LinesInFiles, BeginWhereTheReachBeforeThemLed) {
  const auto lines = linesOf(
      "  - reach: {link: arm, target: [3, 0, 0], start: 2, minimum_jerk: {}}\n"
      "  - reach: {link: arm, target: [1, 0, 0], rpy: [0.1, 0.2, 0.3], end: 1}\n"
      "  - reach: {link: arm, target: [2, 0, 0], start: 1, end: 2, minimum_jerk: {}}\n"
      "  - reach: {link: arm, target: [4, 0, 0], point: [0, 0, 1], start: 3, minimum_jerk: {}}\n"
      "  - reach: {link: arm, target: [5, 0, 0], point: [0, 1, 0], minimum_jerk: {}}\n");
  Kinematics k(sampleModel());
  computeKinematics(sampleModel(), sampleState(), k);
  const Transform arm = framePose(sampleModel(), k, sampleModel().findFrame("arm"));
  EXPECT_EQ(lines.at(0).p_start, Vector3(2.0, 0.0, 0.0));
  EXPECT_EQ(lines.at(2).p_start, Vector3(1.0, 0.0, 0.0));
  EXPECT_EQ(lines.at(2).R_start, rpyRotation(Vector3(0.1, 0.2, 0.3)));
  EXPECT_EQ(lines.at(3).p_start, arm * Vector3(0.0, 0.0, 1.0));
  EXPECT_EQ(lines.at(3).R_start, arm.R);
  EXPECT_EQ(lines.at(4).p_start, arm * Vector3(0.0, 1.0, 0.0));
}

// Two lines in a row, the second from where the first has led: the hand is never far from either.
TEST(LinesInFiles, OfTwoInARowTheArmIsLedAlongBoth) {
  const Model arm =
      loadUrdf(std::filesystem::path(SOFTGAUSS_SOURCE_DIR) / "data" / "robots" / "arm.urdf");
  State state(arm);
  Data data(arm);
  gdd::GoalDirectedController controller(arm);
  const TempFolder folder;
  controller.goals = readGoals(
      folder.write("goals.yaml",
                   "goals:\n"
                   "  - reach: {link: hand, target: [0.5, 0.3, 0.5], weight: 1e5, end: 1.5,\n"
                   "            minimum_jerk: {duration: 1.5}}\n"
                   "  - reach: {link: hand, target: [0.5, -0.2, 0.6], weight: 1e5, start: 1.5,\n"
                   "            minimum_jerk: {duration: 1.5}}\n"
                   "  - posture: {weight: 10}\n"),
      arm, state);
  const auto hand = [&] {
    Kinematics k(arm);
    computeKinematics(arm, state, k);
    return framePose(arm, k, arm.findFrame("hand")).p;
  };
  const Vector3 from = hand(), corner(0.5, 0.3, 0.5), to(0.5, -0.2, 0.6);
  double worst = 0.0;
  while (state.time < 2.9999) {
    ASSERT_EQ(controller.step(arm, {}, state, data, nullptr), SolveStatus::converged);
    const bool first = state.time < 1.5;
    const double s = std::min((first ? state.time : state.time - 1.5) / 1.5, 1.0);
    const Vector3 begin = first ? from : corner, end = first ? corner : to;
    const Vector3 place = begin + (end - begin) * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    worst = std::max(worst, (hand() - place).norm());
  }
  // What the control cost and the step leave of ways of 0.5 m.
  EXPECT_LT(worst, 3e-3);
}

}  // namespace
}  // namespace softgauss::io

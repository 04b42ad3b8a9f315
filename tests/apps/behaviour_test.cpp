// SPDX-License-Identifier: Apache-2.0
/// What the commands of the docs make robots do, seen in the logs.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/apps/process.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

/// The log of a run.
Csv logOf(std::vector<std::string> arguments) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv";
  arguments.insert(arguments.end(), {"--log", log, "--quiet"});
  const Outcome outcome = simulate(arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  return Csv(readFile(log));
}

double lowest(const Csv& log, const std::string& column, double from = 0.0) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(log.rows.size()); ++i)
    if (log.number(i, "time_s") >= from) least = std::min(least, log.number(i, column));
  return least;
}

TEST(Behaviour, HumanoidStandsAndReachesForTenSeconds) {
  const Csv log = logOf({dataFile("robots/humanoid.urdf"), "--goals",
                         dataFile("goals/stand_and_reach.yaml"), "--duration", "10"});
  ASSERT_EQ(log.rows.size(), 5001u);
  EXPECT_GT(lowest(log, "q:pelvis.z"), 0.9) << "it stands with the pelvis at 0.92 m";
}

/// The last error of the first goal [m] of a run of the arm.
double lastError(std::vector<std::string> arguments) {
  const io::TempFolder folder;
  const std::string summary = folder.path() / "summary.json";
  arguments.insert(arguments.end(), {"--summary", summary, "--quiet", dataFile("robots/arm.urdf")});
  const Outcome outcome = simulate(arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  const auto json = nlohmann::json::parse(readFile(summary));
  return json["goals"][0]["final_error_m"];
}

// MODEL comes last: options of several values leave it alone. A place may have blanks.
TEST(Behaviour, AReachAloneEndsAtItsPlace) {
  EXPECT_SMALL(lastError({"--duration", "4", "--reach", "hand=0.5, 0.3, 0.5"}), 1e-3);
  // 2.5 kg of weight for a kilogram, and no posture of weight: 1/(1 + w) of the free fall stays.
  EXPECT_GT(
      lastError({"--duration", "4", "--control-cost", "total", "--reach", "hand=0.5,0.3,0.5@51"}),
      1e-3);
  EXPECT_SMALL(lastError({"--integrator", "rk4", "--duration", "4", "--reach", "hand=0.5,0.3,0.5"}),
               1e-3);
}

TEST(Behaviour, AHeavierReachLeavesLessToThePosture) {
  double last = std::numeric_limits<double>::infinity();
  for (const char* weight : {"1", "100", "1e4"}) {
    const double left = lastError(
        {"--duration", "6", "--posture=1", "--reach", std::string("hand=0.5,0.3,0.5@") + weight});
    EXPECT_LT(left, 0.5 * last) << weight;
    last = left;
  }
}

TEST(Behaviour, WhatIsHeldStays) {
  const Csv log = logOf({"--hold", "hand", "--duration", "1", dataFile("robots/arm.urdf")});
  const int last = static_cast<int>(log.rows.size()) - 1;
  for (const std::string& column : log.columns)
    if (column.starts_with("q:")) {
      EXPECT_SMALL(log.number(last, column) - log.number(0, column), 1e-6) << column;
    }
}

TEST(Behaviour, AWeightBelowZeroIsRefused) {
  for (const std::string option : {"--reach=hand=0.5,0.3,0.5@-1", "--posture=-2"}) {
    const Outcome outcome = simulate({option, dataFile("robots/arm.urdf")});
    EXPECT_EQ(outcome.exitCode, 2) << option;
    EXPECT_NE(outcome.err.find("expected 0 to 1e12"), std::string::npos) << outcome.err;
  }
}

// By the paper's price it would sink: what holds it up costs more than the reach is worth.
TEST(Behaviour, AReachAloneLeavesTheHumanoidOnItsFeet) {
  const std::vector<std::string> reach = {dataFile("robots/humanoid.urdf"), "--reach",
                                          "right_hand=0.45,-0.25,1.1", "--duration", "5"};
  EXPECT_GT(lowest(logOf(reach), "q:pelvis.z"), 0.9);
  std::vector<std::string> byPaper = reach;
  byPaper[2] += "@100";  // beside which no posture holds the robot up
  byPaper.insert(byPaper.end(), {"--control-cost", "total"});
  EXPECT_LT(lowest(logOf(byPaper), "q:pelvis.z"), 0.5);
}

// Soles that touch to the last bit press by rounding or do not, which says nothing of who stands.
TEST(Behaviour, AReachLeavesOnItsFeetWhatJustTouches) {
  const io::TempFolder folder;
  const std::string rounded = readFile(dataFile("robots/humanoid.urdf"));
  const std::string level = std::regex_replace(rounded, std::regex("1\\.57079632679"),
                                               fmt::format("{:.17g}", 0.5 * M_PI));
  ASSERT_NE(level, rounded);
  const Csv log = logOf({folder.write("level.urdf", level), "--reach", "right_hand=0.45,-0.25,1.1",
                         "--duration", "2"});
  EXPECT_GT(lowest(log, "q:pelvis.z"), 0.9);
}

// Half a second for the hand to close; then the ball hangs on the fingers alone.
TEST(Behaviour, HandClosesOnABallAndHoldsItForFiveSeconds) {
  const std::string scene = dataFile("scenes/hand_and_ball.yaml");
  const Csv log = logOf({scene, "--duration", "6"});
  const int last = static_cast<int>(log.rows.size()) - 1;
  EXPECT_NEAR(log.number(last, "time_s"), 6.0, 1e-9);
  EXPECT_GT(lowest(log, "q:ball.z"), 0.255) << "it does not drop from 0.26 m";
  EXPECT_GE(lowest(log, "contacts", 0.8), 3.0) << "fingers on several sides";
  // It rests: in the last four seconds it creeps by less than a millimetre.
  for (const char* axis : {"q:ball.x", "q:ball.y", "q:ball.z"})
    EXPECT_SMALL(log.number(last, axis) - log.number(1000, axis), 1e-3);
}

/// A run of goals that cannot be met: the ways that are left [mm], and how fast the joints still
/// turn [rad/s].
struct Leftover {
  std::vector<double> ways;
  double speed = 0.0;

  explicit Leftover(std::vector<std::string> arguments) {
    const io::TempFolder folder;
    const std::string file = folder.path() / "log.csv", summary = folder.path() / "summary.json";
    arguments.insert(arguments.end(), {"--log", file, "--summary", summary});
    const Outcome outcome = simulate(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = nlohmann::json::parse(readFile(summary));
    for (const auto& goal : json["goals"])
      if (goal["unit"] == "m") ways.push_back(1e3 * double{goal["final_error_m"]});
    const Csv log(readFile(file));
    for (const std::string& column : log.columns)
      if (column.starts_with("v:"))
        speed =
            std::max(speed, std::abs(log.number(static_cast<int>(log.rows.size()) - 1, column)));
  }
};

TEST(Behaviour, ArmsWhoseGoalsCannotBeMetComeToRest) {
  const std::string arm = dataFile("robots/arm.urdf");
  const Leftover weak({dataFile("scenes/weak_arm.yaml"), "--duration", "8"});
  ASSERT_EQ(weak.ways.size(), 1u);
  EXPECT_NEAR(weak.ways[0], 804.0, 10.0) << "it sinks to where the torques suffice";
  EXPECT_LT(weak.speed, 0.05);
  const Leftover far({arm, "--goals", dataFile("goals/arm_out_of_reach.yaml"), "--duration", "8"});
  ASSERT_EQ(far.ways.size(), 1u);
  EXPECT_NEAR(far.ways[0], 720.0, 2.0) << "1.68 m from the shoulder, for an arm of 0.96 m";
  EXPECT_LT(far.speed, 0.05);
  const Leftover two({arm, "--goals", dataFile("goals/arm_two_places.yaml"), "--duration", "6"});
  ASSERT_EQ(two.ways.size(), 2u);
  const double apart = 1e3 * std::hypot(0.4, 0.1);
  EXPECT_NEAR(two.ways[0], 0.75 * apart, 1.0);
  EXPECT_NEAR(two.ways[1], 0.25 * apart, 1.0);
  EXPECT_LT(two.speed, 0.05);
}

TEST(Behaviour, TheSameBallDropsFromAHandWithoutGoals) {
  std::string text = readFile(dataFile("scenes/hand_and_ball.yaml"));
  text.resize(text.find("goals:"));
  const std::string urdf = "../robots/hand.urdf";
  text.replace(text.find(urdf), urdf.size(), dataFile("robots/hand.urdf"));
  const io::TempFolder folder;
  const Csv log = logOf({folder.write("open.yaml", text), "--passive", "--duration", "1.2"});
  EXPECT_LT(lowest(log, "q:ball.z"), 0.1);
}

}  // namespace
}  // namespace softgauss::test

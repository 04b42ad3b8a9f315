// SPDX-License-Identifier: Apache-2.0
/// What a log holds beside the joints: forces, goals, the whole; and the files beside it.

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

constexpr double kGravity = 9.81;

// A humanoid at rest: the ground carries its weight, below its centre of mass, and it has no
// momentum. Sums by link and by contact are the same force.
TEST(LogContents, ForcesOfAStandingRobotCarryIt) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv", contacts = folder.path() / "contacts.csv",
                    summary = folder.path() / "summary.json";
  const Outcome outcome =
      simulate({dataFile("robots/humanoid.urdf"), "--posture", "--duration", "2", "--log", log,
                "--contacts", contacts, "--summary", summary, "--quiet"});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const auto json = nlohmann::json::parse(readFile(summary));
  const double weight = kGravity * json["model"]["mass_kg"].get<double>();
  const Csv table(readFile(log));
  const int row = static_cast<int>(table.rows.size()) - 2;
  double sum = 0.0;
  for (const std::string& column : table.columns)
    if (column.starts_with("f:") && column.ends_with(".z")) sum += table.number(row, column);
  EXPECT_NEAR(sum, weight, 0.01 * weight);
  for (const char* axis : {".x", ".y"}) {
    EXPECT_NEAR(table.number(row, std::string("com") + axis),
                table.number(row, std::string("cop") + axis), 0.005);
    EXPECT_SMALL(table.number(row, std::string("momentum") + axis), 0.1);
    EXPECT_SMALL(table.number(row, std::string("angular_momentum") + axis), 0.1);
  }
  const Csv touching(readFile(contacts));
  std::map<std::string, double> byTime;
  for (int i = 0; i < static_cast<int>(touching.rows.size()); ++i)
    if (touching.rows[i][touching.find("link_a")] == "world")
      byTime[touching.rows[i][touching.find("time_s")]] += touching.number(i, "fz_N");
  EXPECT_NEAR(byTime.at(table.rows[row][0]), sum, 1e-9 * sum);
}

// Not a sum of steps, which is off by rounding that grows.
TEST(LogContents, TimeIsTheNumberOfTheStepTimesItsLength) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv";
  std::vector<std::string> arguments = passiveArm("3");
  arguments.insert(arguments.end(), {"--log", log, "--log-every", "100", "--quiet"});
  const Outcome outcome = simulate(arguments);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const Csv table(readFile(log));
  ASSERT_EQ(table.rows.size(), 16u);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(table.number(i, "time_s"), 100 * i * 0.002) << i;
}

// The state at the end has no control and no forces: fields without a value, not zeros.
TEST(LogContents, TheLastRowHasNoZerosThatAreNoValues) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv";
  const Outcome outcome =
      simulate({dataFile("robots/humanoid.urdf"), "--reach", "right_hand=0.4,-0.2,1.1",
                "--duration", "0.02", "--log", log, "--quiet"});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const Csv table(readFile(log));
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const std::string& name = table.columns[c];
    const bool ofAStep = name.starts_with("a:") || name.starts_with("u:") ||
                         name.starts_with("f:") || name.starts_with("cop") ||
                         name.ends_with("_us") || name == "iterations" || name == "stationarity" ||
                         name == "dual_updates" || name.ends_with("violation");
    EXPECT_EQ(table.rows.back()[c].empty(), ofAStep) << name;
    EXPECT_FALSE(table.rows[1][c].empty()) << name;
  }
}

TEST(SummaryFile, SaysWhatTheRunIsMadeFrom) {
  const io::TempFolder folder;
  const std::string robot = folder.write("ball.urdf", R"(<robot name="ball"><link name="ball">
<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
</link></robot>)");
  const std::string summary = folder.path() / "summary.json";
  const Outcome outcome = simulate(
      {robot, "--passive", "--ground", "none", "--duration", "0.01", "--summary", summary});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const auto origin = nlohmann::json::parse(readFile(summary))["origin"];
  EXPECT_EQ(
      origin["command_line"],
      "simulate_gdd " + robot + " --passive --ground none --duration 0.01 --summary " + summary);
  ASSERT_EQ(origin["files"].size(), 1u);
  EXPECT_EQ(origin["files"][0]["path"], robot);
  EXPECT_EQ(origin["files"][0]["sha256"],
            "5807071451546740ea19694b15a7acc947a50370ac4db4c214097f010b7c180c");
  EXPECT_NE(origin["compiler"], "");
  EXPECT_NE(origin["processor"], "");
}

// In the log as in the verdict.
TEST(LogContents, GoalsOfOneNameAreToldApart) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv";
  const Outcome outcome =
      simulate({dataFile("robots/arm.urdf"), "--reach", "hand=0.5,0.3,0.5", "--reach",
                "hand=0.5,0.2,0.5", "--duration", "0.5", "--log", log});
  const std::string text = readFile(log), header = text.substr(0, text.find('\n'));
  for (const std::string name : {"reach hand", "reach hand (2)"}) {
    EXPECT_NE(header.find("error:" + name + " [m]"), std::string::npos) << header;
    EXPECT_NE(outcome.out.find(" " + name + ": "), std::string::npos) << outcome.out;
  }
}

}  // namespace
}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0
/// How runs of simulate_gdd end: exit codes 0, 3 and 130.

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "softgauss/engine/model/model.hpp"
#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

TEST(Run, HelpAndVersionAreDone) {
  for (const char* option : {"--help", "--help-all", "--version"}) {
    const Outcome outcome = simulate({option});
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_NE(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
  }
  const std::string help = simulate({"--help-all"}).out;
  for (const char* option : {"--base",
                             "--base-height",
                             "--ground",
                             "--duration",
                             "--timestep",
                             "--integrator",
                             "--integration-tolerance",
                             "--cone",
                             "--gdd-solver",
                             "--reach",
                             "--goals",
                             "--compatibility",
                             "--passive",
                             "--torques",
                             "--q0",
                             "--effects",
                             "--explain",
                             "--log",
                             "--log-every",
                             "--contacts",
                             "--details",
                             "--summary",
                             "--meshes",
                             "--collision",
                             "--package-path",
                             "--quiet",
                             "--view",
                             "--plot",
                             "--version"})
    EXPECT_NE(help.find(option), std::string::npos) << option;
}

// Five commands, then options that there are, on a screen of 40 lines of 100 characters.
TEST(Run, HelpFitsAScreenAndBeginsWithExamples) {
  const std::string help = simulate({"--help"}).out, all = simulate({"--help-all"}).out;
  std::istringstream lines(help);
  int count = 0, examples = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    EXPECT_LE(line.size(), 100u) << line;
    if (!line.starts_with("  simulate_gdd ")) continue;
    ++examples;
    EXPECT_LT(count, 8) << line;
  }
  EXPECT_LE(count, 40);
  EXPECT_EQ(examples, 5);
  const std::regex option("--[a-z0-9-]+");
  for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it)
    EXPECT_TRUE(std::regex_search(all, std::regex(it->str() + "[^a-z0-9-]"))) << it->str();
}

TEST(Run, EveryRobotOfTheProjectRuns) {
  for (const char* robot : {"humanoid", "hand", "arm"}) {
    const std::string file = dataFile(std::string("robots/") + robot + ".urdf");
    const Outcome outcome = simulate({file, "--passive", "--duration", "0.2", "--quiet"});
    EXPECT_EQ(outcome.exitCode, 0) << robot << ": " << outcome.err;
  }
}

TEST(Run, OptionsOfTheSceneAreObeyed) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv";
  const Outcome outcome =
      simulate({dataFile("robots/humanoid.urdf"), "--passive", "--duration", "0.01", "--timestep",
                "0.001", "--base-height", "5", "--ground", "none", "--q0",
                "right_elbow=0.25,left_knee=0.5", "--effects", "gravity", "--log", log, "--quiet"});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const Csv csv((readFile(log)));
  ASSERT_EQ(csv.rows.size(), 11u);
  std::string base;
  for (const std::string& column : csv.columns)
    if (column.starts_with("q:") && column.compare(column.size() - 2, 2, ".z") == 0)
      base = column.substr(2, column.size() - 4);
  EXPECT_EQ(csv.number(0, "q:" + base + ".z"), 5.0);
  EXPECT_EQ(csv.number(0, "q:right_elbow"), 0.25);
  EXPECT_EQ(csv.number(0, "q:left_knee"), 0.5);
  EXPECT_EQ(csv.number(10, "contacts"), 0.0);
  // Nothing but gravity: it falls, and no joint moves.
  EXPECT_NEAR(csv.number(10, "v:" + base + ".vz"), -9.81 * 0.01, 1e-9);
  EXPECT_NEAR(csv.number(10, "v:left_knee"), 0.0, 1e-9);
}

// GDD with each: the control is held over the step.
TEST(Run, EveryIntegratorRunsUnderGoals) {
  for (const IntegratorName& i : kIntegratorNames) {
    const std::string name(i.name);
    const io::TempFolder folder;
    const std::string summary = folder.path() / "summary.json";
    const Outcome outcome =
        simulate({dataFile("robots/humanoid.urdf"), "--reach", "right_hand=0.4,-0.2,1.1",
                  "--duration", "0.2", "--integrator", name, "--summary", summary, "--quiet"});
    ASSERT_EQ(outcome.exitCode, 0) << name << ": " << outcome.err;
    const nlohmann::json json = nlohmann::json::parse(readFile(summary));
    EXPECT_EQ(json["options"]["integrator"], name);
    EXPECT_EQ(json["steps"], 100);
    EXPECT_GT(json["gdd_minima"]["certified"].get<int>() + json["gdd_minima"]["kinks"].get<int>(),
              95)
        << name;
  }
  const Outcome wrong = simulate({dataFile("robots/arm.urdf"), "--integrator", "euler"});
  EXPECT_EQ(wrong.exitCode, 2);
}

// Solver 1 finds few certificates among elliptic cones, and rounding takes pivots of its matrices.
// The run goes on, and says how it went.
TEST(Run, EllipticConesUnderAGoalEndInOrder) {
  const auto reach = [](const std::string& target, const std::string& duration) {
    return simulate({dataFile("robots/humanoid.urdf"), "--cone", "elliptic", "--reach",
                     "right_hand=" + target, "--duration", duration});
  };
  for (const std::string x : {"0.301", "0.303"}) {
    const Outcome outcome = reach(x + ",-0.5,0.5", "0.4");
    EXPECT_EQ(outcome.exitCode, 0) << x << outcome.err;
  }
  const Outcome outcome = reach("0.3,-0.5,0.5", "1.2");
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("without a certificate"), std::string::npos) << outcome.out;
}

// A simulation that blows up says so, and leaves a log up to the last good step.
TEST(Run, BlowUpEndsWithCodeThreeAndItsOutputs) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv", summary = folder.path() / "summary.json";
  const std::string torques =
      folder.write("torques.csv", "time_s,u:shoulder_yaw,u:elbow_pitch\n0,0,0\n0.1,1e12,-1e12\n");
  const Outcome outcome = simulate({dataFile("robots/arm.urdf"), "--torques", torques, "--duration",
                                    "1", "--log", log, "--summary", summary, "--quiet"});
  EXPECT_EQ(outcome.exitCode, 3) << outcome.err;
  // Time, joint, and what to try.
  EXPECT_NE(outcome.err.find("t = "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("--timestep"), std::string::npos) << outcome.err;
  const Csv csv((readFile(log)));
  ASSERT_GE(csv.rows.size(), 50u) << "all good steps are there";
  for (const auto& row : csv.rows) {
    ASSERT_EQ(row.size(), csv.columns.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool state = csv.columns[i].rfind("q:", 0) == 0 || csv.columns[i].rfind("v:", 0) == 0;
      EXPECT_TRUE(!state || std::isfinite(std::strtod(row[i].c_str(), nullptr))) << row[i];
    }
  }
  const auto json = nlohmann::json::parse(readFile(summary));
  EXPECT_NE(json["outcome"], "completed");
  EXPECT_EQ(json["steps"].get<std::size_t>() + 1, csv.rows.size());
}

TEST(Run, InterruptEndsWithCode130AndItsOutputs) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv", summary = folder.path() / "summary.json";
  const Outcome outcome =
      simulate({dataFile("robots/arm.urdf"), "--reach", "hand=0.5,0.3,0.5", "--duration", "100000",
                "--log", log, "--summary", summary, "--quiet"},
               0.3, log);
  EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
  const Csv csv((readFile(log)));
  ASSERT_GE(csv.rows.size(), 2u);
  EXPECT_EQ(csv.rows.back().size(), csv.columns.size()) << "the last row is whole";
  const auto json = nlohmann::json::parse(readFile(summary));
  EXPECT_EQ(json["outcome"], "interrupted");
  EXPECT_EQ(json["steps"].get<std::size_t>() + 1, csv.rows.size());
}

// Three seconds of the README's demonstration.
TEST(RunLong, HumanoidReachesAsTheReadmeSays) {
  const io::TempFolder folder;
  const std::string summary = folder.path() / "summary.json";
  const Outcome outcome =
      simulate({dataFile("robots/humanoid.urdf"), "--goals", dataFile("goals/stand_and_reach.yaml"),
                "--duration", "3", "--summary", summary, "--quiet"});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const auto json = nlohmann::json::parse(readFile(summary));
  for (const auto& goal : json["goals"])
    if (goal["name"].get<std::string>().starts_with("reach")) {
      EXPECT_LT(goal["final_error_m"].get<double>(), 0.2 * goal["initial_error_m"].get<double>());
    }
  EXPECT_LE(json["physics_violation"]["p95"].get<double>(), 1e-8);
  EXPECT_LE(json["max_control_ratio"].get<double>(), 1.0);
}

}  // namespace
}  // namespace softgauss::test

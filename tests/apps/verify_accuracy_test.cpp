// SPDX-License-Identifier: Apache-2.0
/// accuracy_cost --verify-accuracy: whether --accuracy keeps its word.

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "tests/apps/process.hpp"
#include "tests/apps/short_study.hpp"

namespace softgauss::test {
namespace {

/// verify_accuracy.csv of a problem: every accuracy was looked at, promised and kept.
void expectKept(const std::string& out, const std::string& problem) {
  std::istringstream in(readFile(out + "/verify_accuracy.csv"));
  std::string line;
  std::getline(in, line);
  int cases = 0;
  while (std::getline(in, line)) {
    // problem, accuracy, counted, found, "setting", error, …
    double accuracy = 0.0;
    int counted = 0, found = 0;
    ASSERT_EQ(line.rfind(problem + ",", 0), 0u) << line;
    ASSERT_EQ(
        std::sscanf(line.c_str() + problem.size(), ",%lf,%d,%d,", &accuracy, &counted, &found), 3)
        << line;
    EXPECT_EQ(counted, 1) << line;
    EXPECT_EQ(found, 1) << line;
    const std::size_t quote = line.find("\",");
    ASSERT_NE(quote, std::string::npos);
    EXPECT_LE(std::stod(line.substr(quote + 2)), accuracy) << line;
    ++cases;
  }
  EXPECT_EQ(cases, 5);
}

// The promise of --accuracy, on a problem whose motion is known in closed form. Times are not
// looked at here: the machine may be busy.
TEST(AccuracyCost, ChosenSettingsKeepTheirAccuracy) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  const Outcome outcome =
      runProgram("accuracy_cost", study("pendulum", out, {"--verify-accuracy"}));
  ASSERT_LE(outcome.exitCode, 1) << outcome.err;  // 1: some took too long
  expectKept(out, "pendulum");
  EXPECT_NE(readFile(out + "/accuracy_table.md").find("| pendulum | 0.01 m |"), std::string::npos);
}

// The same of simulate_gdd itself: a closed form, and forces that become a table of controls.
TEST(AccuracyCost, RunsOfUsersKeepTheirAccuracy) {
  for (const char* problem : {"pendulum", "arm"}) {
    const io::TempFolder folder;
    const std::string out = folder.path() / "study";
    std::vector<std::string> arguments = study(problem, out, {"--verify-accuracy", "--runs"});
    *std::find(arguments.begin(), arguments.end(), "32") = "8";
    const Outcome outcome = runProgram("accuracy_cost", arguments);
    ASSERT_LE(outcome.exitCode, 1) << outcome.err;  // 1: some took too long
    expectKept(out, problem);
    EXPECT_NE(outcome.out.find("trials took"), std::string::npos) << "what simulate_gdd says";
    // Steps by 4/3 and 3/2, tolerances by half decades, and no other engine.
    const std::string table = readFile(out + "/runs.csv");
    EXPECT_NE(table.find("Dormand-Prince to 3.2e-06"), std::string::npos);
    EXPECT_NE(table.find(",0.010666666666666666,"), std::string::npos);
    EXPECT_EQ(table.find("mujoco,"), std::string::npos);
  }
}

// The promise of --accuracy on every problem that is not chaotic: in 95 % of the cases the true
// error is within what was asked, and the time within 1.5 times the best of all settings.
TEST(AccuracyCostLong, AccuracyIsKeptAndIsNotDear) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  std::vector<std::string> arguments{"--out",     out, "--robots",          dataFile("robots"),
                                     "--repeats", "3", "--verify-accuracy", "--most-steps",
                                     "32"};
  for (const char* problem :
       {"pendulum", "spring_mass_damper", "double_pendulum", "spinning_top", "free_body", "chain_5",
        "arm", "humanoid_in_the_air", "bouncing_ball", "box_stack"})
    arguments.insert(arguments.end(), {"--scene", problem});
  const Outcome outcome = runProgram("accuracy_cost", arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.out.substr(outcome.out.find("pendulum   "));
  std::istringstream in(readFile(out + "/verify_accuracy.csv"));
  int cases = 0;
  for (std::string line; std::getline(in, line);)
    cases += line.find(",1,1,\"") != std::string::npos;
  EXPECT_GE(cases, 45);
}

}  // namespace
}  // namespace softgauss::test

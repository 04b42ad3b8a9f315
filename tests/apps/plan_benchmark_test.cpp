// SPDX-License-Identifier: Apache-2.0
/// plan_benchmark on small tasks: it repeats itself, plans are what actuators can do, and AILQR
/// finds contacts where iLQR finds none.

#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

using PlanJson = nlohmann::ordered_json;

PlanJson plans(const std::string& task, const char* starts) {
  const io::TempFolder folder;
  const std::string file = folder.path() / "plans.json";
  const Outcome outcome = runProgram(
      "plan_benchmark", {dataFile("plans/" + task + ".yaml"), "--starts", starts, "--json", file});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find(task), std::string::npos);
  PlanJson json = PlanJson::parse(readFile(file));
  for (PlanJson& method : json) {
    method.erase("phase_i_iteration_s");
    for (PlanJson& trial : method["trials"]) {
      EXPECT_EQ(trial["root_force"], 0.0);
      EXPECT_LE(trial["gap"], 1e-10);
      trial.erase("seconds");
    }
  }
  return json;
}

TEST(PlanBenchmark, SameSeedSameFigures) {
  EXPECT_EQ(plans("acrobot", "2"), plans("acrobot", "2"));
}

// The wheel of the spinner is 82 mm away: standing still costs 48, and no change of a control is
// felt there.
TEST(PlanBenchmark, FindsContactsThatControlsAloneDoNot) {
  const PlanJson json = plans("spinner", "1");
  ASSERT_EQ(json.size(), 3u);
  EXPECT_EQ(json[0]["method"], "AILQR");
  EXPECT_LT(json[0]["trials"][0]["cost"], 5.0);
  EXPECT_EQ(json[2]["method"], "iLQR");
  EXPECT_GT(json[2]["trials"][0]["cost"], 40.0);
}

// Starts differ, and the pole ends up each time; the same seeds give the same runs.
TEST(PlanBenchmark, RecedingPlansBringBackWhatIsDisturbed) {
  const io::TempFolder folder;
  const std::string file = folder.path() / "runs.json";
  const auto runs = [&](const char* seed) {
    const Outcome outcome = runProgram(
        "plan_benchmark",
        {dataFile("plans/cart_pole.yaml"), "--mpc", "--runs", "2", "--seed", seed, "--json", file});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(" 2/2 "), std::string::npos) << outcome.out;
    return PlanJson::parse(readFile(file))[0]["runs"];
  };
  const PlanJson first = runs("1");
  EXPECT_EQ(first, runs("1"));
  EXPECT_EQ(first[1], runs("2")[0]);
  EXPECT_NE(first[0]["final"], first[1]["final"]);
  for (const PlanJson& run : first) EXPECT_EQ(run["failed_ticks"], 0);
}

// An acrobot that swings up and holds is unstable: what the plan costs is kept by goal directed
// dynamics and by the feedback, for both know the value model.
TEST(PlanBenchmark, ActsPlansOutByThreeLaws) {
  const io::TempFolder folder;
  const std::string file = folder.path() / "runs.json";
  const Outcome outcome = runProgram(
      "plan_benchmark", {dataFile("plans/acrobot.yaml"), "--act", "--runs", "2", "--json", file});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const PlanJson laws = PlanJson::parse(readFile(file));
  ASSERT_EQ(laws.size(), 3u);
  for (const PlanJson& law : laws) {
    EXPECT_EQ(law["planned"], laws[0]["planned"]);
    EXPECT_EQ(law["costs"].size(), 2u);
    if (law["law"] == "u + PD") continue;
    EXPECT_EQ(law["carried_out"], 2) << law["law"];
    // Steps of 2 ms in place of 50.
    EXPECT_NEAR(law["undisturbed"], law["planned"], 0.1 * law["planned"].get<double>());
  }
}

TEST(PlanBenchmark, DrawsCostsOverIterations) {
  const io::TempFolder folder;
  const std::string file = folder.path() / "curves.svg";
  const Outcome outcome = runProgram(
      "plan_benchmark", {dataFile("plans/acrobot.yaml"), "--starts", "1", "--picture", file});
  if (outcome.err.find("gnuplot") != std::string::npos) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const std::string svg = readFile(file);
  for (const char* name : {"<svg", "acrobot", "AILQR", "phase F", "iLQR"})
    EXPECT_NE(svg.find(name), std::string::npos) << name;
}

TEST(PlanBenchmark, TellsWhatIsWrong) {
  const Outcome runs =
      runProgram("plan_benchmark", {dataFile("plans/acrobot.yaml"), "--runs", "1"});
  EXPECT_EQ(runs.exitCode, 2);
  EXPECT_NE(runs.err.find("--mpc or --act"), std::string::npos) << runs.err;
  EXPECT_NE(runProgram("plan_benchmark", {"nowhere.yaml"}).exitCode, 0);
  const Outcome pushed =
      runProgram("plan_benchmark", {dataFile("plans/acrobot.yaml"), "--push", "1"});
  EXPECT_NE(pushed.exitCode, 0);
  EXPECT_NE(pushed.err.find("--mpc"), std::string::npos) << pushed.err;
  const Outcome outcome =
      runProgram("plan_benchmark", {dataFile("scenes/two_arms.yaml"), "--starts", "1"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("plan"), std::string::npos);
}

}  // namespace
}  // namespace softgauss::test

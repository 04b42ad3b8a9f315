// SPDX-License-Identifier: Apache-2.0
/// Sweep files as simulate_batch reads them.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/apps/batch_run.hpp"

namespace softgauss::test {
namespace {

TEST(Sweep, AListTakesThePlaceOfAGrid) {
  const Batch batch("model: " + dataFile("robots/arm.urdf") +
                    "\npassive: true\nduration: 0.01\nlist:\n"
                    "  - {mass:hand: 1, v:elbow_pitch: 0.5}\n"
                    "  - {mass:hand: 2, v:elbow_pitch: -0.5}\n");
  ASSERT_EQ(batch.run("out").exitCode, 0);
  const Csv csv(batch.table("out"));
  ASSERT_EQ(csv.rows.size(), 2u);
  EXPECT_EQ(csv.number(1, "mass:hand"), 2.0);
  EXPECT_EQ(csv.number(1, "v:elbow_pitch"), -0.5);
}

// A wider range lets a joint start where the file's own would not; a reach has a weight.
TEST(Sweep, OptionsRangesAndWeightsAreTaken) {
  const auto errorOf = [](const std::string& reach) {
    const Batch batch("model: " + dataFile("robots/arm.urdf") +
                      "\nduration: 2\nexact_diagonal: true\nq0: {shoulder_yaw: 0.1}\n"
                      "without: [supported_mass]\nposture: 1000\nreach: {hand: " +
                      reach + "}\nvary:\n  upper:elbow_pitch: [2]\n  q:elbow_pitch: [0.7]\n");
    const Outcome outcome = batch.run("out");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    const Csv csv(batch.table("out"));
    EXPECT_EQ(csv.rows.size(), 1u);
    for (const std::string& column : csv.columns)
      if (column.find("reach hand") != std::string::npos &&
          column.find("final_error") != std::string::npos)
        return csv.number(0, column);
    ADD_FAILURE() << batch.table("out");
    return std::nan("");
  };
  EXPECT_LT(errorOf("[0.5, 0.2, 0.5]"), 1e-3);
  EXPECT_LT(errorOf("{target: [0.5, 0.2, 0.5]}"), 1e-3);
  EXPECT_GT(errorOf("{target: [0.5, 0.2, 0.5], weight: 50}"), 0.1);  // the posture outweighs it
}

// The SRDF is found from the folder of the sweep, as its other files are.
TEST(Sweep, AStateOfAnSrdfIsAStart) {
  const auto table = [](const std::string& start) {
    const io::TempFolder folder;
    folder.write("arm.srdf",
                 "<robot name='arm'><group_state name='up' group='arm'>"
                 "<joint name='elbow_pitch' value='0.4'/></group_state></robot>");
    const std::string sweep = folder.write(
        "sweep.yaml", "model: " + dataFile("robots/arm.urdf") + "\nduration: 0.1\npassive: true\n" +
                          start + "\nvary: {mass:hand: [1]}\nmeasure: [hand.x]\n");
    const std::string out = folder.path() / "out";
    const Outcome outcome = runProgram("simulate_batch", {sweep, "--out", out, "--quiet"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return readFile(out + "/runs.csv");
  };
  EXPECT_EQ(table("srdf: arm.srdf\nstate: up"), table("q0: {elbow_pitch: 0.4}"));
}

TEST(Sweep, MistakesAreToldWithFileLineAndKey) {
  const std::string model = "model: " + dataFile("robots/arm.urdf") + "\npassive: true\n";
  const std::tuple<std::string, int, std::string> cases[] = {
      {model + "vry: {}\n", 3, "vary"},
      {model + "vary:\n  mas:hand: [1]\n", 4, "did you mean 'mass'"},
      {model + "vary:\n  mass:hnd: [1]\n", 4, "did you mean 'hand'"},
      {model + "vary:\n  mass:hand: [1, -2]\n", 4, "above 0"},
      {model + "vary:\n  mass:hand: {uniform: [2, 1]}\n", 4, "smaller one first"},
      {model + "vary:\n  mass:hand: {from: 1, to: 2, steps: 1.5}\n", 4, "whole number"},
      {model + "vary:\n  reach:hand.x: [1]\n", 4, "no reach goal"},
      {model + "runs: 0\n", 3, "whole number"},
      {model + "measure: [hand.w]\n", 3, "ball.z"},
      {model + "measure: [hnd.z]\n", 3, "did you mean 'hand'"},
      {model + "duration: long\n", 3, "duration"},
      {"passive: true\n", 1, "model"},
      {"model: " + dataFile("robots/arm.urdf") + "\n", 1, "passive"},
      {model + "list: [{mass:hand: 1}, {mass:base: 1}]\n", 3, "first item"},
      {model + "vary:\n  q:elbow_pitch: [0, 5]\n", 4,
       "outside the joint's range -1.5 .. 0.6, in run 1"},
      {model + "vary:\n  upper:elbow_pitch: [0.2]\n  q:elbow_pitch: [0.5]\n", 5, "-1.5 .. 0.2"},
      {model + "step_doubling: 3\n", 3, "found '3', expected true or false"},
      {model + "cone: round\n", 3, "one of pyramidal, elliptic"},
      {model + "q0: {elbow_pitch: much}\n", 3, "joints and their positions"},
      {"model: " + dataFile("robots/arm.urdf") + "\nreach: {hand: {weight: 3}}\n", 2, "target"},
      {"model: " + dataFile("robots/arm.urdf") + "\nposture: 1\nmpc: true\n", 3, "no other"},
      {model + "plan: true\n", 3, "no other"},
      {"model: " + dataFile("plans/acrobot.yaml") + "\nplan: true\nmpc: true\n", 3, "one of"},
  };
  for (const auto& [text, line, part] : cases) {
    const Batch batch(text);
    const Outcome outcome = batch.run("out");
    EXPECT_EQ(outcome.exitCode, 2) << text;
    EXPECT_NE(outcome.err.find("sweep.yaml:" + std::to_string(line) + ":"), std::string::npos)
        << text << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << text << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(batch.out("out"))) << text;
  }
}

TEST(Sweep, ReadsItsExamples) {
  for (const char* name : {"arm_reach", "grasp", "pushed_humanoid", "pushed_quadruped"}) {
    const io::TempFolder folder;
    const Outcome outcome =
        runProgram("simulate_batch",
                   {dataFile(std::string("sweeps/") + name + ".yaml"), "--only", "10000000"});
    // It is read, planned and has fewer runs than that.
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_NE(outcome.err.find("expected a run from 0 to"), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace softgauss::test

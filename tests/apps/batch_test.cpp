// SPDX-License-Identifier: Apache-2.0
/// simulate_batch as a user runs it.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

using Json = nlohmann::json;

/// The arm reaches six places with three masses, for a moment.
std::string armSweep(const std::string& rest = "", const std::string& duration = "0.05") {
  return "model: " + dataFile("robots/arm.urdf") + "\nduration: " + duration +
         "\nreach: {hand: [0.5, 0.2, 0.5]}\nseed: 3\nruns: 2\n"
         "vary:\n  mass:hand: [0.5, 1, 2]\n  damping:elbow_pitch: {from: 0, to: 2, steps: 2}\n"
         "  reach:hand.x: {uniform: [0.3, 0.6]}\n  q:elbow_pitch: {normal: [-0.3, 0.1]}\n" +
         rest;
}

struct Batch {
  io::TempFolder folder;
  std::string sweep;
  explicit Batch(const std::string& text) : sweep(folder.write("sweep.yaml", text)) {}
  std::string out(const std::string& name) const { return (folder.path() / name).string(); }
  Outcome run(const std::string& name, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {sweep, "--quiet", "--out", out(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("simulate_batch", arguments);
  }
  std::string table(const std::string& name) const { return readFile(out(name) + "/runs.csv"); }
  Json summary(const std::string& name) const {
    return Json::parse(readFile(out(name) + "/summary.json"));
  }
};

TEST(Batch, WritesTheSameTableForAnyNumberOfThreads) {
  const Batch batch(armSweep());
  for (const char* threads : {"1", "2", "7"}) {
    const Outcome outcome = batch.run(threads, {"--threads", threads});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(batch.table(threads), batch.table("1"));
  }
  const Csv csv(batch.table("1"));
  EXPECT_EQ(csv.rows.size(), 12u);
  const Json summary = batch.summary("7");
  EXPECT_EQ(summary["completed"], 12);
  EXPECT_EQ(summary["threads"], 7);
  EXPECT_GT(summary["bytes_per_run"], 0);
  EXPECT_GT(summary["steps_per_s_and_core"], 0.0);
}

TEST(Batch, LastParameterOfTheGridChangesFastest) {
  const Batch batch(armSweep());
  ASSERT_EQ(batch.run("out").exitCode, 0);
  const Csv csv(batch.table("out"));
  for (int run = 0; run < 12; ++run) {
    EXPECT_EQ(csv.number(run, "run"), run);
    EXPECT_EQ(csv.number(run, "mass:hand"), std::vector<double>({0.5, 1, 2})[run / 4]);
    EXPECT_EQ(csv.number(run, "damping:elbow_pitch"), (run / 2) % 2 * 2.0);
    EXPECT_GE(csv.number(run, "reach:hand.x"), 0.3);
    EXPECT_LT(csv.number(run, "reach:hand.x"), 0.6);
  }
}

TEST(Batch, DrawsFollowTheirLaws) {
  const Batch batch("model: " + dataFile("robots/arm.urdf") +
                    "\npassive: true\nduration: 0.002\nruns: 400\nvary:\n"
                    "  v:elbow_pitch: {uniform: [-1, 3]}\n  v:wrist_pitch: {normal: [2, 0.5]}\n"
                    "  mass:hand: {log_uniform: [0.01, 100]}\n");
  ASSERT_EQ(batch.run("out").exitCode, 0);
  const Csv csv(batch.table("out"));
  double uniform = 0.0, normal = 0.0, squares = 0.0, logarithm = 0.0;
  for (int run = 0; run < 400; ++run) {
    uniform += csv.number(run, "v:elbow_pitch") / 400;
    normal += csv.number(run, "v:wrist_pitch") / 400;
    squares += std::pow(csv.number(run, "v:wrist_pitch") - 2.0, 2.0) / 400;
    logarithm += std::log10(csv.number(run, "mass:hand")) / 400;
  }
  // Four standard deviations of a mean of 400: of width/√12, 0.5, 0.25 √2 and 4/√12, over 20.
  EXPECT_NEAR(uniform, 1.0, 0.23);
  EXPECT_NEAR(normal, 2.0, 0.1);
  EXPECT_NEAR(squares, 0.25, 0.071);
  EXPECT_NEAR(logarithm, 0.0, 0.23);
}

TEST(Batch, ARunIsWhatSimulateGddRuns) {
  const Batch batch("model: " + dataFile("robots/humanoid.urdf") +
                    "\nduration: 0.1\nreach: {right_hand: [0.4, -0.2, 1.1]}\n");
  ASSERT_EQ(batch.run("out").exitCode, 0);
  const Csv csv(batch.table("out"));
  const Outcome one =
      simulate({dataFile("robots/humanoid.urdf"), "--reach", "right_hand=0.4,-0.2,1.1",
                "--duration", "0.1", "--quiet", "--summary", batch.out("one.json")});
  ASSERT_EQ(one.exitCode, 0) << one.err;
  const Json summary = Json::parse(readFile(batch.out("one.json")));
  EXPECT_EQ(csv.number(0, "final_error:reach right_hand [m]"),
            summary["goals"][0]["final_error_m"].get<double>());
  EXPECT_EQ(csv.number(0, "energy_J"), summary["energy_J"]["final"].get<double>());
  EXPECT_EQ(csv.number(0, "max_penetration_m"), summary["max_penetration_m"].get<double>());
  EXPECT_EQ(csv.number(0, "max_control_ratio"), summary["max_control_ratio"].get<double>());
  EXPECT_EQ(csv.number(0, "fell"), 0.0);
}

TEST(Batch, OneRunIsRepeatedWithAPage) {
  const Batch batch(armSweep());
  const Outcome outcome =
      runProgram("simulate_batch", {batch.sweep, "--only", "5", "--view", batch.out("5.html")});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("mass:hand = 1\n"), std::string::npos) << outcome.out;
  EXPECT_NE(readFile(batch.out("5.html")).find("</html>"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(batch.out("sweep")));
  EXPECT_EQ(runProgram("simulate_batch", {batch.sweep, "--only", "12"}).exitCode, 2);
}

TEST(Batch, AFailingRunIsToldWithTheCommandThatRepeatsIt) {
  // An explicit integrator under forces of which one step makes numbers beyond double's.
  const Batch batch(
      "model: " + dataFile("robots/arm.urdf") +
      "\npassive: true\nduration: 0.1\nintegrator: rk4\nvary: {\"gravity:z\": [-9.81, -1e12], "
      "\"v:elbow_pitch\": [0, 1e11]}\n");
  ASSERT_EQ(batch.run("out").exitCode, 0);
  const Json summary = batch.summary("out");
  const Csv csv(batch.table("out"));
  EXPECT_EQ(csv.rows[0][csv.find("outcome")], "completed");
  ASSERT_GE(summary["failed"], 1);
  const Json failure = summary["failures"].back();
  EXPECT_NE(failure["reason"].get<std::string>().find("non-finite"), std::string::npos);
  EXPECT_NE(failure["command"].get<std::string>().find(
                "--only " + std::to_string(failure["run"].get<int>()) + " --view"),
            std::string::npos);
}

TEST(Batch, GoesOnWhereItWasKilled) {
  const Batch batch(armSweep("measure: [hand.z]\n", "3"));
  ASSERT_EQ(batch.run("whole", {"--threads", "1"}).exitCode, 0);
  // Killed as soon as some runs are kept, at three moments; then once more to the end.
  for (const char* lines : {"2", "4", "9"}) {
    const std::string out = batch.out(std::string("killed_") + lines);
    const Outcome killed = runShell(batch.folder.path(),
                                    "simulate_batch sweep.yaml --quiet --threads 1 --checkpoint "
                                    "--out " +
                                        out +
                                        " & pid=$!\n"
                                        "while [ $(cat " +
                                        out +
                                        "/checkpoint.txt 2>/dev/null | wc -l)"
                                        " -lt " +
                                        lines +
                                        " ] && kill -0 $pid 2>/dev/null; do :; done\n"
                                        "kill -9 $pid; wait $pid\n"
                                        // What a write that was cut off leaves.
                                        "printf '11\\t0.1\\t11,22' >>" +
                                        out +
                                        "/checkpoint.txt\n"
                                        "simulate_batch sweep.yaml --quiet --checkpoint --out " +
                                        out);
    ASSERT_EQ(killed.exitCode, 0) << killed.err;
    EXPECT_EQ(readFile(out + "/runs.csv"), batch.table("whole"));
    EXPECT_FALSE(std::filesystem::exists(out + "/checkpoint.txt"));
  }
}

TEST(Batch, ACheckpointOfAnotherSweepIsRefused) {
  const Batch batch(armSweep());
  std::filesystem::create_directories(batch.out("out"));
  batch.folder.write("out/checkpoint.txt", "softgauss simulate_batch checkpoint 1 other\n");
  const Outcome outcome = batch.run("out", {"--checkpoint"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("another sweep"), std::string::npos) << outcome.err;
}

TEST(Batch, RanksGiveTheTableOfOneThread) {
  const Batch batch(armSweep());
  ASSERT_EQ(batch.run("one", {"--threads", "1"}).exitCode, 0);
  const std::string mpirun =
      "mpirun --allow-run-as-root --oversubscribe -n 3 simulate_batch sweep.yaml --quiet --out "
      "ranks";
  const Outcome outcome = runShell(batch.folder.path(), "command -v mpirun || exit 77\n" + mpirun);
  if (outcome.exitCode == 77) GTEST_SKIP() << "no mpirun here";
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  if (batch.summary("ranks")["ranks"] == 1) GTEST_SKIP() << "built without MPI";
  EXPECT_EQ(batch.summary("ranks")["ranks"], 3);
  EXPECT_EQ(batch.table("ranks"), batch.table("one"));
}

TEST(Batch, ACheckpointInUseIsRefused) {
  const Batch batch(armSweep("", "30"));
  const Outcome outcome =
      runShell(batch.folder.path(),
               "simulate_batch sweep.yaml --quiet --threads 1 --checkpoint --out out & first=$!\n"
               "until [ -s out/checkpoint.txt ]; do :; done\n"
               "simulate_batch sweep.yaml --quiet --checkpoint --out out; code=$?\n"
               "kill -9 $first; wait $first\n exit $code");
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("in use by another simulate_batch"), std::string::npos) << outcome.err;
}

TEST(Batch, LinesOfACheckpointThatAreNotWholeAreDoneAgain) {
  const Batch batch(armSweep());
  ASSERT_EQ(batch.run("whole", {"--checkpoint"}).exitCode, 0);
  ASSERT_EQ(
      runShell(batch.folder.path(),
               "simulate_batch sweep.yaml --quiet --checkpoint --out out & pid=$!\n"
               "until [ -s out/checkpoint.txt ]; do :; done; kill -9 $pid; wait $pid\n"
               "head -n 1 out/checkpoint.txt >first\n"
               "{ cat first; printf '3\\t0.1\\t3,17,0.5\\n5\\t0.1\\t4,1\\n'; } >out/checkpoint.txt")
          .exitCode,
      0);
  ASSERT_EQ(batch.run("out", {"--checkpoint"}).exitCode, 0);
  EXPECT_EQ(batch.table("out"), batch.table("whole"));
}

TEST(Batch, AnotherSweepsCheckpointStays) {
  const Batch batch(armSweep());
  std::filesystem::create_directories(batch.out("out"));
  batch.folder.write("out/checkpoint.txt", "softgauss simulate_batch checkpoint 1 other\n");
  ASSERT_EQ(batch.run("out").exitCode, 0);
  EXPECT_TRUE(std::filesystem::exists(batch.out("out") + "/checkpoint.txt"));
}

TEST(Batch, NamesWithCommasAndBlanksAreQuoted) {
  const io::TempFolder folder;
  const std::string robot = folder.write("a robot.urdf", R"(<robot name="r"><link name="world"/>
    <link name="a, b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0"
    iyz="0"/></inertial></link><joint name="j" type="continuous"><parent link="world"/>
    <child link="a, b"/></joint></robot>)");
  const std::string sweep = folder.write(
      "a sweep.yaml", "model: " + robot +
                          "\npassive: true\nduration: 0.01\n"
                          "integrator: rk4\nvary: {\"mass:a, b\": [1, 2], v:j: [1e11]}\n"
                          "measure: [\"a, b.z\"]\n");
  const std::string out = (folder.path() / "out").string();
  ASSERT_EQ(runProgram("simulate_batch", {sweep, "--quiet", "--out", out}).exitCode, 0);
  EXPECT_NE(readFile(out + "/runs.csv").find("\"mass:a, b\",v:j,"), std::string::npos);
  const Json summary = Json::parse(readFile(out + "/summary.json"));
  EXPECT_TRUE(summary["figures"].contains("a, b.z_m")) << summary["figures"];
}

TEST(Batch, TheCommandThatRepeatsARunIsOneForTheShell) {
  const io::TempFolder folder;
  const std::string sweep = folder.write(
      "it's one.yaml", "model: " + dataFile("robots/arm.urdf") +
                           "\npassive: true\nduration: 0.1\nintegrator: rk4\n"
                           "vary: {\"gravity:z\": [-1e12], \"v:elbow_pitch\": [1e11]}\n");
  const std::string out = (folder.path() / "out").string();
  ASSERT_EQ(runProgram("simulate_batch", {sweep, "--quiet", "--out", out}).exitCode, 0);
  const Json summary = Json::parse(readFile(out + "/summary.json"));
  ASSERT_EQ(summary["failed"], 1);
  const Outcome again = runShell(folder.path(), summary["failures"][0]["command"]);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "run_0.html")) << again.err;
}

TEST(Batch, RangesThatAreInvertedFailTheirRun) {
  const Batch batch("model: " + dataFile("robots/arm.urdf") +
                    "\npassive: true\nduration: 0.01\nvary: {lower:elbow_pitch: [-1, 1], "
                    "upper:elbow_pitch: [0.5]}\n");
  ASSERT_EQ(batch.run("out").exitCode, 0);
  const Csv csv(batch.table("out"));
  EXPECT_EQ(csv.rows[0][csv.find("outcome")], "completed");
  EXPECT_EQ(csv.rows[1][csv.find("outcome")], "failed");
  EXPECT_NE(batch.table("out").find("ranges from 1 to 0.5"), std::string::npos);
}

TEST(Batch, WhatFollowsAJointStartsWhereItHasIt) {
  const io::TempFolder folder;
  const std::string link = R"(<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0"
    ixz="0" iyz="0"/></inertial></link>)";
  const std::string robot = folder.write(
      "pair.urdf",
      R"(<robot name="r"><link name="world"/><link name="a">)" + link + R"(<link name="b">)" +
          link +
          R"(<joint name="lead" type="prismatic"><parent link="world"/><child link="a"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
    <joint name="follow" type="prismatic"><parent link="world"/><child link="b"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/><mimic joint="lead"/></joint></robot>)");
  const std::string sweep = folder.write(
      "sweep.yaml", "model: " + robot +
                        "\npassive: true\nduration: 0.1\n"
                        "vary: {\"gravity:z\": [0], q:lead: [1]}\nmeasure: [a.z, b.z]\n");
  const std::string out = (folder.path() / "out").string();
  ASSERT_EQ(runProgram("simulate_batch", {sweep, "--quiet", "--out", out}).exitCode, 0);
  const Csv csv(readFile(out + "/runs.csv"));
  EXPECT_NEAR(csv.number(0, "a.z_m"), 1.0, 1e-9);
  EXPECT_NEAR(csv.number(0, "b.z_m"), 1.0, 1e-9);
}

TEST(Batch, AListTakesThePlaceOfAGrid) {
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
TEST(Batch, OptionsRangesAndWeightsAreTaken) {
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
TEST(Batch, AStateOfAnSrdfIsAStart) {
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

TEST(Batch, MistakesAreToldWithFileLineAndKey) {
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

TEST(Batch, ReadsItsExamples) {
  for (const char* name : {"arm_reach", "grasp", "pushed_humanoid"}) {
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

// SPDX-License-Identifier: Apache-2.0
/// simulate_batch as a user runs it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/batch_run.hpp"

namespace softgauss::test {
namespace {

/// The arm reaches six places with three masses, for a moment.
std::string armSweep(const std::string& rest = "", const std::string& duration = "0.05") {
  return "model: " + dataFile("robots/arm.urdf") + "\nduration: " + duration +
         "\nreach: {hand: [0.5, 0.2, 0.5]}\nseed: 3\nruns: 2\n"
         "vary:\n  mass:hand: [0.5, 1, 2]\n  damping:elbow_pitch: {from: 0, to: 2, steps: 2}\n"
         "  reach:hand.x: {uniform: [0.3, 0.6]}\n  q:elbow_pitch: {normal: [-0.3, 0.1]}\n" +
         rest;
}

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

// Each plans from its own start, with its own masses, for the target of the scene.
TEST(Batch, PlansEachRunAndActsItOut) {
  const std::string sweep = "model: " + dataFile("plans/cart_pole.yaml") +
                            "\nseed: 3\nruns: 2\nvary:\n  mass:pole: [0.08, 0.12]\n"
                            "  v:hinge: {uniform: [-0.3, 0.3]}\n";
  const Batch plan(sweep + "plan: true\n"), mpc(sweep + "mpc: true\nduration: 4\n");
  for (const Batch* batch : {&plan, &mpc}) {
    for (const char* threads : {"1", "3"}) {
      const Outcome outcome = batch->run(threads, {"--threads", threads});
      ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
      EXPECT_EQ(batch->table(threads), batch->table("1"));
    }
    const Csv csv(batch->table("1"));
    ASSERT_EQ(csv.rows.size(), 4u);
    for (int run = 0; run < 4; ++run) {
      EXPECT_EQ(csv.number(run, "carried_out"), 1.0) << run;
      EXPECT_GT(csv.number(run, "planned_cost"), csv.number(run, "final_cost"));
      EXPECT_EQ(csv.number(run, "simulated_s"), batch == &plan ? 3.0 : 4.0);
    }
    EXPECT_NE(csv.number(0, "planned_cost"), csv.number(1, "planned_cost"));
  }
  // As the program does it.
  const Csv csv(plan.table("1"));
  const Outcome one = runProgram("simulate_batch", {plan.sweep, "--only", "2"});
  EXPECT_NE(one.out.find(fmt::format("planned:      cost {:.4g},", csv.number(2, "planned_cost"))),
            std::string::npos)
      << one.out;
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

}  // namespace
}  // namespace softgauss::test

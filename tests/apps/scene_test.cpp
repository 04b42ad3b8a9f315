// SPDX-License-Identifier: Apache-2.0
/// Scene files on the command line.

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

TEST(SceneRun, EverySceneOfTheProjectRuns) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(dataFile("scenes"))) {
    if (entry.path().extension() != ".yaml") continue;
    const Outcome outcome = simulate({entry.path(), "--duration", "0.2", "--quiet"});
    EXPECT_EQ(outcome.exitCode, 0) << entry.path() << ": " << outcome.err;
    EXPECT_EQ(simulate({entry.path(), "--explain"}).exitCode, 0);
    ++scenes;
  }
  EXPECT_GT(scenes, 0);
}

TEST(SceneRun, ObjectsFallOntoTheGroundAndRobotsReach) {
  const io::TempFolder folder;
  const std::string scene = folder.write(
      "scene.yaml", "ground: 0.5\nrobots: [{name: one, urdf: " + dataFile("robots/arm.urdf") +
                        ", position: [0, 0, 0.5]}]\n"
                        "objects:\n"
                        "  - {name: low, sphere: {radius: 0.1}, position: [2, 0, 0.7]}\n"
                        "  - {name: standing, box: {size: [0.1, 0.1, 0.3]}, position: [1, 1, 9], "
                        "on_ground: true}\n"
                        "goals: [reach: {link: one/hand, target: [0.5, 0.3, 1.0]}]\n");
  const std::string log = folder.path() / "log.csv", summary = folder.path() / "summary.json";
  const Outcome outcome =
      simulate({scene, "--duration", "1.5", "--log", log, "--summary", summary, "--quiet"});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const Csv csv((readFile(log)));
  const int last = static_cast<int>(csv.rows.size()) - 1;
  EXPECT_EQ(csv.number(0, "q:low.z"), 0.7);
  EXPECT_NEAR(csv.number(last, "q:low.z"), 0.6, 1e-3);
  EXPECT_NEAR(csv.number(0, "q:standing.z"), 0.65, 1e-12);
  EXPECT_NEAR(csv.number(last, "q:standing.z"), 0.65, 1e-3);
  const auto json = nlohmann::json::parse(readFile(summary));
  EXPECT_LT(json["goals"][0]["final_error_m"], 0.2 * double{json["goals"][0]["initial_error_m"]});
}

// What a scene says of pairs, effects and wrenches reaches the run; the command line overrides it.
TEST(SceneRun, PairsOptionsAndWrenchesAct) {
  const io::TempFolder folder;
  const std::string head =
      "objects:\n"
      "  - {name: rough, box: {size: [0.2, 0.2, 0.2]}, mass: 1}\n"
      "  - {name: smooth, box: {size: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 1, 0.1]}\n"
      "pairs: [{a: smooth, b: ground, condim: 1}]\n"
      "wrenches:\n"
      "  - {link: rough, force: [2, 0, 0], end: 0.5}\n"
      "  - {link: smooth, force: [2, 0, 0], end: 0.5}\n";
  const std::string scene = folder.write("scene.yaml", head);
  const std::string off =
      folder.write("off.yaml", head + "options: {effects: [gravity, coriolis, ground_contact]}\n");
  const std::string log = folder.path() / "log.csv";
  const auto speeds = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> all = {"--duration", "0.5", "--log", log, "--quiet"};
    all.insert(all.begin(), arguments.begin(), arguments.end());
    const Outcome outcome = simulate(all);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    const Csv csv((readFile(log)));
    const int last = static_cast<int>(csv.rows.size()) - 1;
    return std::pair(csv.number(last, "v:rough.vx"), csv.number(last, "v:smooth.vx"));
  };
  const auto [rough, smooth] = speeds({scene});
  EXPECT_LT(rough, 0.05) << "friction holds 2 N of 9.81 N, but for creep";
  EXPECT_NEAR(smooth, 1.0, 1e-9) << "2 N for 0.5 s on 1 kg";
  EXPECT_EQ(speeds({off}), std::pair(0.0, 0.0));
  EXPECT_EQ(speeds({off, "--effects", "auto"}), std::pair(rough, smooth));
  const Outcome told = simulate({scene, "--explain"});
  for (const char* words : {"external_wrench", "2 wrenches, first 'rough'", "(2, 0, 0) N",
                            "1 pair with a surface of its own"})
    EXPECT_NE(told.out.find(words), std::string::npos) << words << "\n" << told.out;
}

/// A hand whose followers stand before their leader in the file, some in a chain, on oblique axes.
std::string handOfFollowers() {
  std::string urdf = "<robot name=\"hand\"><link name=\"world\"/>";
  for (const char* link : {"l0", "l1", "l2", "l3"})
    urdf += std::string("<link name=\"") + link +
            "\"><inertial><mass value=\"0.3\"/><inertia ixx=\"0.01\" iyy=\"0.02\" izz=\"0.03\" "
            "ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>";
  const auto joint = [&](const char* name, const char* type, const char* parent, const char* child,
                         const char* mimic) {
    urdf += fmt::format(
        "<joint name=\"{}\" type=\"{}\"><parent link=\"{}\"/><child link=\"{}\"/><axis xyz=\"0.3 "
        "-0.4 2\"/><limit lower=\"-3\" upper=\"3\" effort=\"9\" velocity=\"9\"/>{}</joint>",
        name, type, parent, child, mimic);
  };
  joint("sib", "revolute", "world", "l1",
        "<mimic joint=\"lead\" multiplier=\"-0.5\" offset=\"0.2\"/>");
  joint("lead", "revolute", "world", "l0", "");
  joint("second", "revolute", "l1", "l2",
        "<mimic joint=\"sib\" multiplier=\"2\" offset=\"-0.1\"/>");
  joint("slide", "prismatic", "l0", "l3",
        "<mimic joint=\"lead\" multiplier=\"0.1\" offset=\"0.05\"/>");
  return urdf + "</robot>";
}

// Without forces nothing moves where each follower is where its leader has it.
TEST(SceneRun, FollowersStartWhereTheirLeaderHasThem) {
  const io::TempFolder folder;
  const std::string urdf = folder.write("hand.urdf", handOfFollowers());
  const std::string scene = folder.write(
      "scene.yaml", "ground: none\nrobots: [{urdf: hand.urdf, joints: {lead: 0.6}}]\n");
  const std::string log = folder.path() / "log.csv";
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--passive", "--effects", "no_gravity", "--duration", "0.5",
                                       "--log", log, "--quiet"});
    const Outcome outcome = simulate(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return Csv(readFile(log));
  };
  const double sib = -0.5 * 0.6 + 0.2;
  const std::pair<const char*, double> expected[] = {{"q:lead", 0.6},
                                                     {"q:sib", sib},
                                                     {"q:second", 2.0 * sib - 0.1},
                                                     {"q:slide", 0.1 * 0.6 + 0.05}};
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{urdf, "--q0", "lead=0.6"},
        {scene},
        {folder.write("plain.yaml", "ground: none\nrobots: [{urdf: hand.urdf}]\n"), "--q0",
         "lead=0.6"}}) {
    const Csv csv = run(arguments);
    for (const int row : {0, static_cast<int>(csv.rows.size()) - 1})
      for (const auto& [column, value] : expected)
        EXPECT_NEAR(csv.number(row, column), value, 1e-12) << column << " in row " << row;
  }
  // What is named itself has to be there too, and goes along where --q0 moves its leader.
  const auto naming = [&](const char* place) {
    return folder.write(
        "named.yaml",
        std::string("ground: none\nrobots: [{urdf: hand.urdf, joints: {lead: 0.3, sib: ") + place +
            "}}]\n");
  };
  const Csv csv = run({naming("0.05"), "--q0", "lead=0.6"});
  for (const auto& [column, value] : expected) EXPECT_NEAR(csv.number(0, column), value, 1e-12);
  const Outcome refused = simulate({naming("0.7"), "--passive"});
  EXPECT_EQ(refused.exitCode, 2);
  EXPECT_NE(refused.err.find("expected 0.05"), std::string::npos) << refused.err;
}

/// gdd_solver and the warnings in the summary of a short run.
std::pair<std::string, std::string> solverTold(std::vector<std::string> arguments) {
  const io::TempFolder folder;
  const std::string summary = folder.path() / "summary.json";
  arguments.insert(arguments.end(), {"--duration", "0.02", "--summary", summary, "--quiet"});
  const Outcome outcome = simulate(arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  const auto json = nlohmann::json::parse(readFile(summary));
  return {json["options"]["gdd_solver"], json["warnings"].dump()};
}

TEST(SceneRun, FollowsGoalsWithTheSolverThatIsNamed) {
  const io::TempFolder folder;
  const std::string text = "robots: [{name: one, urdf: " + dataFile("robots/arm.urdf") +
                           "}]\ngoals: [reach: {link: one/hand, target: [0.5, 0.3, 0.5]}]\n";
  const std::string plain = folder.write("plain.yaml", text);
  const std::string named =
      folder.write("named.yaml", text + "options: {gdd_solver: augmented-lagrangian}\n");
  EXPECT_EQ(solverTold({plain}).first, "active-set");
  EXPECT_EQ(solverTold({named}).first, "augmented-lagrangian");
  EXPECT_EQ(solverTold({named, "--gdd-solver", "active-set"}).first, "active-set");
}

// Only solver 1 updates multipliers, and only solver 2 ends on the physics; both find the control.
TEST(SceneRun, SolversOfTheCommandLineAreTwo) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv";
  const auto run = [&](const std::string& solver) {
    const Outcome outcome =
        simulate({dataFile("robots/humanoid.urdf"), "--reach", "right_hand=0.45,-0.25,1.1",
                  "--gdd-solver", solver, "--duration", "0.02", "--log", log, "--quiet"});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return Csv(readFile(log));
  };
  const Csv one = run("augmented-lagrangian"), two = run("active-set");
  double updates = 0.0;
  for (int i = 0; i < static_cast<int>(one.rows.size()); ++i) {
    updates += one.number(i, "dual_updates");
    EXPECT_EQ(two.number(i, "dual_updates"), 0.0);
    for (const char* joint : {"right_elbow", "left_knee"}) {
      const std::string column = std::string("u:") + joint;
      // Solver 1 ends at a root force of up to 1e-7 N, and knees answer in kind.
      EXPECT_NEAR(one.number(i, column), two.number(i, column), 1e-4) << i << ", " << column;
    }
  }
  EXPECT_GT(updates, 0.0);
}

TEST(SceneRun, ConesAreSolverOnesAndTheSummarySaysSo) {
  const std::vector<std::string> standing = {dataFile("robots/humanoid.urdf"), "--reach",
                                             "right_hand=0.45,-0.25,1.1", "--cone", "elliptic"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), standing.begin(), standing.end());
    return solverTold(more);
  };
  const char* const words = "active-set does not know elliptic cones";
  const auto left = with({}), asked = with({"--gdd-solver", "active-set"});
  EXPECT_EQ(left.first, "augmented-lagrangian");
  EXPECT_EQ(left.second.find(words), std::string::npos) << left.second;
  EXPECT_EQ(asked.first, "augmented-lagrangian");
  EXPECT_NE(asked.second.find(words), std::string::npos) << asked.second;
  // Nothing touches: nothing is left to solver 1.
  EXPECT_EQ(with({"--base-height", "5", "--ground", "none"}).first, "active-set");
}

// Two motors with a gear of 40 share two joints: what either joint gets, the other does not. Both
// solvers bring the hand there with motors at their bounds on the way.
TEST(SceneRun, ADifferentialWristStaysWithinItsMotors) {
  const io::TempFolder folder;
  for (const char* solver : {"active-set", "augmented-lagrangian"}) {
    const std::string log = folder.path() / "log.csv", summary = folder.path() / "summary.json";
    const Outcome outcome =
        simulate({dataFile("scenes/differential_wrist.yaml"), "--duration", "3", "--gdd-solver",
                  solver, "--control-cost", "total", "--ignore-velocity-limits", "--log", log,
                  "--summary", summary, "--quiet"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const Csv csv((readFile(log)));
    double left = 0.0, right = 0.0, violation = 0.0;
    for (int row = 0; row + 1 < static_cast<int>(csv.rows.size()); ++row) {
      const double bend = csv.number(row, "u:wrist_pitch"), turn = csv.number(row, "u:flange_roll");
      left = std::max(left, std::abs(bend + turn) / 80.0);
      right = std::max(right, std::abs(bend - turn) / 80.0);
      violation = std::max(violation, csv.number(row, "physics_violation"));
    }
    EXPECT_LE(left, 0.1 * (1.0 + 1e-12)) << solver;
    EXPECT_LE(right, 0.1 * (1.0 + 1e-12)) << solver;
    EXPECT_GT(std::max(left, right), 0.1 * (1.0 - 1e-12)) << solver << ": the bounds are to be met";
    EXPECT_LT(violation, 1e-9);
    const auto json = nlohmann::json::parse(readFile(summary));
    EXPECT_NEAR(double{json["max_control_ratio"]}, 1.0, 1e-12);
    EXPECT_LT(double{json["goals"][0]["final_error_m"]}, 0.02) << solver;
  }
}

// Two stacks and a ball that falls on the second: in the end all sleep, where they lie otherwise.
TEST(SceneRun, WhatRestsSleeps) {
  const io::TempFolder folder;
  std::string text = "ground: 0\nobjects:\n";
  for (int i = 0; i < 4; ++i)
    text += "  - {name: box" + std::to_string(i) +
            ", box: {size: [0.2, 0.2, 0.2]}, mass: 1, position: [" + std::to_string(i / 2) +
            ", 0, " + std::to_string(0.1 + 0.2 * (i % 2)) + "]}\n";
  text += "  - {name: ball, sphere: {radius: 0.1}, mass: 1, position: [1, 0, 4]}\n";
  const std::string scene = folder.write("scene.yaml", text);
  const std::string own = folder.write("own.yaml", text + "options: {sleep: objects}\n");
  std::vector<Csv> logs;
  for (const bool sleeps : {false, true}) {
    const std::string log = folder.path() / "log.csv", summary = folder.path() / "summary.json";
    std::vector<std::string> arguments = {scene, "--duration", "3",    "--log",
                                          log,   "--summary",  summary};
    if (sleeps) arguments.insert(arguments.end(), {"--sleep", "objects"});
    const Outcome outcome = simulate(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    logs.emplace_back(readFile(log));
    const auto json = nlohmann::json::parse(readFile(summary));
    EXPECT_EQ(json.contains("sleep"), sleeps);
    EXPECT_EQ(outcome.out.find("sleep: up to 5 of 5 trees") != std::string::npos, sleeps);
    EXPECT_LT(json["physics_violation"]["max"], 1e-8);
    if (!sleeps) continue;
    EXPECT_EQ(json["sleep"]["trees"], 5);
    EXPECT_EQ(json["sleep"]["most_asleep"], 5);
    EXPECT_EQ(json["sleep"]["wakeups"], 2);  // the stack
    arguments = {own, "--duration", "3", "--log", log, "--summary", summary};
    ASSERT_EQ(simulate(arguments).exitCode, 0);
    EXPECT_EQ(nlohmann::json::parse(readFile(summary))["state_hash"], json["state_hash"]);
  }
  ASSERT_EQ(logs[0].rows.size(), logs[1].rows.size());
  const int last = static_cast<int>(logs[0].rows.size()) - 1;
  for (const char* column : {"q:box0.z", "q:box3.z", "q:ball.z", "energy_J"})
    EXPECT_NEAR(logs[0].number(last - 1, column), logs[1].number(last - 1, column), 1e-3) << column;
  const Outcome refused = simulate({scene, "--sleep", "objects", "--integrator", "runge-kutta-4"});
  EXPECT_EQ(refused.exitCode, 2);
  EXPECT_NE(refused.err.find("--sleep: is for semi-implicit-euler"), std::string::npos)
      << refused.err;
}

TEST(SceneRun, EffectsAreAListOrAllButSome) {
  const auto effects = [](const std::string& text) {
    const Outcome outcome = simulate({dataFile("robots/arm.urdf"), "--passive", "--details",
                                      "--duration", "0.01", "--effects", text});
    const std::size_t at = outcome.out.find("effects:");
    return outcome.exitCode == 0 ? outcome.out.substr(at, outcome.out.find('\n', at) - at)
                                 : outcome.err;
  };
  EXPECT_NE(effects("auto").find(" gravity"), std::string::npos);
  EXPECT_EQ(effects("none").find("gravity"), std::string::npos);
  EXPECT_EQ(effects("no_gravity").find("gravity"), std::string::npos);
  EXPECT_NE(effects("no_gravity").find("coriolis"), std::string::npos);
  EXPECT_EQ(effects("gravity,damping").find("coriolis"), std::string::npos);
  EXPECT_NE(effects("").find("found nothing, expected a value"), std::string::npos);
  EXPECT_NE(effects("no_wind").find("no effect 'no_wind'"), std::string::npos);
}

// Two arms that reach for a box, which sleeps until they touch it.
TEST(SceneRun, ObjectsSleepBesideGoals) {
  const io::TempFolder folder;
  std::vector<Csv> logs;
  for (const std::string sleep : {"none", "objects", "all"}) {
    const std::string log = folder.path() / "log.csv", summary = folder.path() / "summary.json";
    const Outcome outcome = simulate({dataFile("scenes/two_arms.yaml"), "--duration", "1", "--log",
                                      log, "--summary", summary, "--sleep", sleep});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    logs.emplace_back(readFile(log));
    const auto json = nlohmann::json::parse(readFile(summary));
    EXPECT_LT(double{json["physics_violation"]["max"]}, 1e-8);
    EXPECT_EQ(json.contains("sleep"), sleep != "none");
  }
  // What sleep leaves out of the box's motion is far below what the arms do.
  ASSERT_EQ(logs[0].rows.size(), logs[1].rows.size());
  for (int row = 0; row + 1 < static_cast<int>(logs[0].rows.size()); row += 10)
    for (const std::string column : {"q:left/elbow_pitch", "q:box.z"})
      EXPECT_NEAR(logs[0].number(row, column), logs[1].number(row, column), 1e-3)
          << column << " in row " << row;
}

TEST(SceneRun, OptionsOfAUrdfAloneAreRefused) {
  const std::string scene = dataFile("scenes/two_arms.yaml");
  for (const auto& [option, value] :
       {std::pair{"--base", "fixed"}, {"--base-height", "1"}, {"--ground", "0"}}) {
    const Outcome outcome = simulate({scene, option, value});
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_NE(outcome.err.find(option), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace softgauss::test

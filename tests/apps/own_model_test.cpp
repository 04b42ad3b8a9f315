// SPDX-License-Identifier: Apache-2.0
/// accuracy_cost MODEL: a user's model is studied as the built-in problems are, from where
/// simulate_gdd starts it.

#include "apps/accuracy_cost/own_model.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "apps/accuracy_cost/engine_under_test.hpp"
#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

/// Two links that swing, the lower one hinged `length` below the upper one [m].
std::string twoLinks(double length) {
  std::ostringstream text;
  const std::string inertial =
      "<inertial><origin xyz='0 0 -0.2'/><mass value='1'/>"
      "<inertia ixx='0.01' iyy='0.01' izz='0.002' ixy='0' ixz='0' iyz='0'/></inertial>";
  text << "<robot name='two_links'><link name='world'/><link name='upper'>" << inertial
       << "</link><link name='lower'>" << inertial
       << "</link><joint name='shoulder' type='continuous'><parent link='world'/>"
          "<child link='upper'/><origin rpy='0 0.6 0'/><axis xyz='0 1 0'/></joint>"
          "<joint name='elbow' type='continuous'><parent link='upper'/><child link='lower'/>"
          "<origin xyz='0 0 "
       << -length << "'/><axis xyz='0 1 0'/></joint></robot>\n";
  return text.str();
}

app::OwnModel own(const std::string& file, BaseKind base = BaseKind::automatic,
                  const std::string& ground = {}) {
  return {file, base, ground, {}};
}

/// A short study: steps of at least 0.5 ms, each run once.
Outcome study(const std::string& model, const std::string& out,
              const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{model, "--out", out, "--repeats", "0", "--most-steps", "64"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return runProgram("accuracy_cost", arguments);
}

/// A column of the table for a method at a step [s]; NaN where there is no such row.
double cell(const Csv& table, const std::string& label, double step, const std::string& column) {
  for (int row = 0; row < static_cast<int>(table.rows.size()); ++row)
    if (table.rows[row].at(table.find("label")) == label &&
        std::abs(table.number(row, "timestep_s") / step - 1.0) < 1e-9)
      return table.number(row, column);
  return std::nan("");
}

TEST(OwnModel, ErrorsFallWithTheOrder) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study", file = out + "/accuracy_cost.csv";
  const Outcome outcome = study(folder.write("two links.urdf", twoLinks(0.4)), out);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const Csv table(readFile(file));
  const auto order = [&](const std::string& label) {
    return std::log2(cell(table, label, 0.004, "error_m") / cell(table, label, 0.001, "error_m")) /
           2.0;
  };
  // As of the built-in pendulum, after two seconds; what is left of the next order is below 0.2.
  EXPECT_NEAR(order("semi-implicit Euler"), 1.0, 0.2);
  EXPECT_NEAR(order("implicit midpoint"), 2.0, 0.2);
  EXPECT_NEAR(order("Runge-Kutta 4"), 4.0, 0.2);
  for (const char* output : {"accuracy_orders.md", "accuracy_table.md", "accuracy_cost.html"})
    EXPECT_NE(readFile(out + "/" + output).find("two_links.urdf"), std::string::npos) << output;

  // Another model in a file of that name is measured anew.
  ASSERT_EQ(study(folder.write("two links.urdf", twoLinks(0.3)), out).exitCode, 0);
  const Csv other(readFile(file));
  EXPECT_EQ(other.rows.size(), table.rows.size());
  EXPECT_GT(std::abs(cell(other, "Runge-Kutta 4", 0.004, "error_m") /
                         cell(table, "Runge-Kutta 4", 0.004, "error_m") -
                     1.0),
            0.01);
}

TEST(OwnModel, ABallThatLandsIsComparedInWindows) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  const Outcome outcome =
      study(folder.write("ball.yaml",
                         "objects:\n  - {name: ball, sphere: {radius: 0.1}, mass: 1, "
                         "position: [0, 0, 0.3]}\n"),
            out);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const Csv table(readFile(out + "/accuracy_cost.csv"));
  EXPECT_TRUE(std::isnan(cell(table, "semi-implicit Euler", 0.016, "error_m")))
      << "a step of 16 ms is no step for contact";
  EXPECT_GT(cell(table, "semi-implicit Euler", 0.001, "penetration_m"), 0.001) << "it has landed";
  // In a step an error of order 2, from the start of each window.
  EXPECT_NEAR(std::log2(cell(table, "semi-implicit Euler", 0.008, "one_step_m") /
                        cell(table, "semi-implicit Euler", 0.001, "one_step_m")) /
                  3.0,
              2.0, 0.2);
  EXPECT_NE(readFile(out + "/accuracy_cost.html").find("\"window\":0.096"), std::string::npos);
}

TEST(OwnModel, StartsWhereSimulateGddDoes) {
  const io::TempFolder folder;
  const std::string scene = folder.write(
      "scene.yaml", "ground: 0.2\nrobots:\n  - {name: arm, urdf: " + dataFile("robots/arm.urdf") +
                        ", joints: {shoulder_yaw: 0.3}, joint_velocities: {shoulder_yaw: 1}}\n"
                        "objects:\n  - {name: box, box: {size: [0.1, 0.1, 0.3]}, "
                        "position: [1, 1, 9], on_ground: true, velocity: [1, 0, 0]}\n");
  const std::string humanoid = dataFile("robots/humanoid.urdf");
  struct Case {
    app::OwnModel model;
    std::vector<std::string> arguments;
  };
  for (const auto& [file, arguments] :
       {Case{own(scene), {}}, Case{own(humanoid), {}},
        Case{own(humanoid, BaseKind::automatic, "0.5"), {"--ground", "0.5"}},
        Case{own(humanoid, BaseKind::automatic, "none"), {"--ground", "none"}},
        Case{own(humanoid, BaseKind::fixed, ""), {"--base", "fixed"}}}) {
    const std::string log = folder.path() / "log.csv";
    std::vector<std::string> simulated{file.file, "--passive", "--duration", "0.002",
                                       "--log",   log,         "--quiet"};
    simulated.insert(simulated.end(), arguments.begin(), arguments.end());
    const Outcome outcome = simulate(simulated);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const Csv table(readFile(log));
    const app::Problem problem = app::ownProblem(file).problem;
    const Model model = problem.build().build();
    State state(model);
    problem.start(model, state);
    std::vector<double> q, v;
    for (const std::string& column : table.columns) {
      if (column.starts_with("q:")) q.push_back(table.number(0, column));
      if (column.starts_with("v:")) v.push_back(table.number(0, column));
    }
    EXPECT_EQ(q, std::vector<double>(state.q.begin(), state.q.end())) << file.file << file.ground;
    EXPECT_EQ(v, std::vector<double>(state.v.begin(), state.v.end())) << file.file << file.ground;
  }
}

// What MuJoCo does not have leaves its curves out, and a note says so.
TEST(OwnModel, GoesWithoutMujocoWhereThatHasNoCounterpart) {
  if (app::mujocoMethods({}).empty()) GTEST_SKIP() << "MuJoCo was not found";
  const io::TempFolder folder;
  const std::string balls =
      "objects:\n  - {name: a, sphere: {radius: 0.1}, mass: 1, position: [0, 0, 1]}\n"
      "  - {name: b, sphere: {radius: 0.1}, mass: 1, position: [1, 0, 1]}\n";
  const auto hasTheirs = [](const app::Problem& problem) {
    const std::vector<app::Method> methods = app::methodsFor(problem);
    return std::any_of(methods.begin(), methods.end(),
                       [](const app::Method& m) { return m.engine == "mujoco"; });
  };
  const app::OwnProblem plain = app::ownProblem(own(folder.write("plain.yaml", balls)));
  EXPECT_TRUE(hasTheirs(plain.problem));
  EXPECT_TRUE(plain.notes.empty());
  for (const char* more :
       {"constraints: [weld: {link_a: a, link_b: b, pose_a: {position: [1, 0, 0]}}]\n",
        "materials: {default: {stiffness: 1e4}}\n"}) {
    const app::OwnProblem made = app::ownProblem(own(folder.write("more.yaml", balls + more)));
    EXPECT_FALSE(hasTheirs(made.problem)) << more;
    ASSERT_EQ(made.notes.size(), 1u) << more;
    EXPECT_NE(made.notes[0].find("MuJoCo is left out"), std::string::npos) << made.notes[0];
  }
}

// Energy is looked at over 10 s where nothing brakes; elsewhere that is refused.
TEST(OwnModel, OnlyWhatNothingBrakesHasADrift) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study", free = folder.write("a.urdf", twoLinks(0.4));
  const Outcome outcome = runProgram("accuracy_cost", {free, "--drift", "--out", out});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const Csv table(readFile(out + "/drift.csv"));
  int kept = 0;
  for (int row = 0; row < static_cast<int>(table.rows.size()); ++row)
    kept += table.rows[row].at(table.find("method")) == "implicit midpoint" &&
            table.number(row, "energy_worst") < 1e-10;  // it keeps it to rounding
  EXPECT_EQ(kept, 1);
  const std::string arm = dataFile("robots/arm.urdf");
  const Outcome refused = runProgram("accuracy_cost", {arm, "--drift", "--out", out});
  EXPECT_EQ(refused.exitCode, 2);
  EXPECT_NE(refused.err.find(arm + ": --drift"), std::string::npos) << refused.err;
}

TEST(OwnModel, BadInputIsNamed) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  const std::string bad =
      folder.write("bad.urdf",
                   "<robot name='a'>\n<link name='b'>\n<inertial><mass value='much'/></inertial>\n"
                   "</link></robot>\n");
  const std::string still =
      folder.write("still.urdf", "<robot name='a'><link name='world'/></robot>");
  const std::string scene =
      folder.write("scene.yaml", "objects: [{name: a, sphere: {radius: 1}}]\n");
  struct Case {
    std::vector<std::string> arguments;
    std::string said;
  };
  for (const auto& [arguments, said] :
       {Case{{bad}, bad + ":3: link 'b'"}, Case{{still}, still + ": model 'a'"},
        Case{{bad + "x"}, bad + "x: file"}, Case{{scene, "--ground", "0"}, "--ground"},
        Case{{"--base", "fixed"}, "--base requires MODEL"},
        Case{{scene, "--scene", "pendulum"}, "MODEL excludes --scene"}}) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"--out", out});
    const Outcome outcome = runProgram("accuracy_cost", all);
    EXPECT_EQ(outcome.exitCode, 2) << said;
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
  }
}

// Every command that docs/accuracy.md shows for a user's own model, with few and long steps.
TEST(OwnModel, CommandsOfThePageRun) {
  const std::string page = readFile(std::string(SOFTGAUSS_SOURCE_DIR) + "/docs/accuracy.md");
  const std::size_t section = page.find("\n## Your own robot\n");
  ASSERT_NE(section, std::string::npos);
  std::istringstream lines(page.substr(section, page.find("\n## ", section + 1) - section));
  const std::string program = "build/release/bin/accuracy_cost ";
  const io::TempFolder folder;
  int commands = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(program)) continue;
    std::istringstream words(line.substr(program.size(), line.find("  ") - program.size()));
    std::vector<std::string> arguments;
    for (std::string word; words >> word;)
      arguments.push_back(word.starts_with("data/") ? dataFile(word.substr(5)) : word);
    arguments.insert(arguments.end(), {"--out", folder.path() / std::to_string(commands++)});
    if (line.find("--divergence") == std::string::npos)
      arguments.insert(arguments.end(), {"--repeats", "0", "--most-steps", "4"});
    const Outcome outcome = runProgram("accuracy_cost", arguments);
    EXPECT_EQ(outcome.exitCode, 0) << line << "\n" << outcome.err;
  }
  EXPECT_GT(commands, 0);
}

}  // namespace
}  // namespace softgauss::test

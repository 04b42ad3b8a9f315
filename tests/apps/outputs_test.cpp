// SPDX-License-Identifier: Apache-2.0
/// What simulate_gdd writes: log, summary, --explain; scripts outside the project rely on it.

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "softgauss/engine/model/model.hpp"
#include "softgauss/io/urdf.hpp"
#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

using Json = nlohmann::json;

const char* const kTimeColumns[] = {"forward_us", "gdd_us", "step_us"};

/// A run of the humanoid with all outputs.
class LoggedRun {
 public:
  explicit LoggedRun(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--log", log(), "--summary", summary(), "--quiet"});
    outcome = simulate(arguments);
  }
  std::string log() const { return folder_.path() / "log.csv"; }
  std::string summary() const { return folder_.path() / "summary.json"; }
  Csv csv() const { return Csv(readFile(log())); }
  Json json() const { return Json::parse(readFile(summary())); }

  Outcome outcome;

 private:
  io::TempFolder folder_;
};

std::vector<std::string> humanoidReach(const std::string& duration = "0.1") {
  return {dataFile("robots/humanoid.urdf"), "--reach", "right_hand=0.45,-0.25,1.1", "--duration",
          duration};
}

std::set<std::string> keysOf(const Json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

TEST(Log, HeaderIsThatOfTheInterface) {
  const LoggedRun run(humanoidReach("0.01"));
  ASSERT_EQ(run.outcome.exitCode, 0) << run.outcome.err;
  const Model model = io::loadUrdf(dataFile("robots/humanoid.urdf"));
  std::vector<std::string> expected{"time_s"};
  const std::string base = model.jointNames[1];
  for (const char* c : {".x", ".y", ".z", ".qw", ".qx", ".qy", ".qz"})
    expected.push_back("q:" + base + c);
  for (int i = 2; i < model.bodyCount(); ++i) expected.push_back("q:" + model.jointNames[i]);
  for (const char* kind : {"v:", "a:"}) {
    for (const char* c : {".vx", ".vy", ".vz", ".wx", ".wy", ".wz"})
      expected.push_back(kind + base + c);
    for (int i = 2; i < model.bodyCount(); ++i) expected.push_back(kind + model.jointNames[i]);
  }
  for (int i = 2; i < model.bodyCount(); ++i) expected.push_back("u:" + model.jointNames[i]);
  for (const char* name :
       {"contacts", "constraints", "iterations", "dual_updates", "physics_violation",
        "gdd_violation", "stationarity", "forward_us", "gdd_us", "step_us", "energy_J",
        "max_penetration_m", "error:reach right_hand [m]"})
    expected.push_back(name);
  const auto addPlace = [&](const std::string& name) {
    for (const char* c : {".x", ".y", ".z"}) expected.push_back(name + c);
  };
  for (const char* name : {"com", "cop", "momentum", "angular_momentum"}) addPlace(name);
  std::set<std::string> links;
  for (const Geometry& geometry : model.geometries)
    if (links.insert(geometry.link).second) addPlace("f:" + geometry.link);
  EXPECT_EQ(run.csv().columns, expected);
}

TEST(Log, HasARowForEveryStepAndOneForTheEnd) {
  const LoggedRun run(humanoidReach());
  ASSERT_EQ(run.outcome.exitCode, 0) << run.outcome.err;
  const Csv csv = run.csv();
  ASSERT_EQ(csv.rows.size(), 51u);
  for (int i = 0; i < 51; ++i) {
    EXPECT_EQ(csv.rows[i].size(), csv.columns.size());
    EXPECT_NEAR(csv.number(i, "time_s"), 0.002 * i, 1e-12);
  }
  // The first row is the state in which the simulation starts: at rest.
  EXPECT_EQ(csv.number(0, "v:right_elbow"), 0.0);
  EXPECT_NE(csv.number(0, "u:right_elbow"), 0.0);
}

// v⁺ = v + h a and q⁺ = q + ½ h (v + v⁺), so what a row says leads to the next.
TEST(Log, RowsFollowFromEachOther) {
  const LoggedRun run({dataFile("robots/arm.urdf"), "--reach", "hand=0.5,0.3,0.5", "--duration",
                       "0.1", "--timestep", "0.0005"});
  ASSERT_EQ(run.outcome.exitCode, 0) << run.outcome.err;
  const Csv csv = run.csv();
  for (int i = 0; i + 1 < static_cast<int>(csv.rows.size()); ++i) {
    const double v = csv.number(i, "v:elbow_pitch"), next = csv.number(i + 1, "v:elbow_pitch");
    const double q = csv.number(i, "q:elbow_pitch"), nextQ = csv.number(i + 1, "q:elbow_pitch");
    EXPECT_NEAR(nextQ, q + 0.00025 * (v + next), 1e-14);
    // What moves is what was solved.
    EXPECT_NEAR(next - v, 0.0005 * csv.number(i, "a:elbow_pitch"), 1e-12);
  }
}

TEST(Log, NumbersRoundTrip) {
  const LoggedRun run(humanoidReach());
  const Csv csv = run.csv();
  ASSERT_FALSE(csv.rows.empty());
  int long17 = 0;
  for (const auto& row : csv.rows)
    for (const std::string& field : row) {
      char* end = nullptr;
      const double value = std::strtod(field.c_str(), &end);
      ASSERT_EQ(*end, '\0') << field;
      ASSERT_TRUE(std::isfinite(value)) << field;
      // The shortest text is read back bit for bit by the longest.
      char text[40];
      std::snprintf(text, sizeof text, "%.17g", value);
      ASSERT_EQ(std::strtod(text, nullptr), value);
      const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
      long17 += std::count_if(field.begin(), field.end(), isDigit) >= 16;
    }
  EXPECT_GT(long17, 1000) << "numbers are written in full";
}

// A recorded control, fed back, gives the recorded motion bit for bit where nothing else differs.
TEST(Log, TorquesOfALogRepeatItsMotion) {
  const LoggedRun first({dataFile("robots/arm.urdf"), "--reach", "hand=0.5,0.3,0.5", "--duration",
                         "0.2", "--integrator", "semi-implicit-euler"});
  ASSERT_EQ(first.outcome.exitCode, 0) << first.outcome.err;
  const LoggedRun again({dataFile("robots/arm.urdf"), "--torques", first.log(), "--duration", "0.2",
                         "--integrator", "semi-implicit-euler"});
  ASSERT_EQ(again.outcome.exitCode, 0) << again.outcome.err;
  const Csv a = first.csv(), b = again.csv();
  ASSERT_EQ(a.rows.size(), b.rows.size());
  const int last = static_cast<int>(a.rows.size()) - 1;
  for (const char* column : {"q:shoulder_yaw", "q:shoulder_pitch", "q:elbow_pitch"})
    EXPECT_NEAR(a.number(last, column), b.number(last, column), 1e-9) << column;
}

TEST(Log, SameRunTwiceIsTheSameButForTimes) {
  const LoggedRun first(humanoidReach("0.3")), second(humanoidReach("0.3"));
  const Csv a = first.csv(), b = second.csv();
  ASSERT_EQ(a.columns, b.columns);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  ASSERT_EQ(a.rows.size(), 151u);
  for (std::size_t c = 0; c < a.columns.size(); ++c) {
    const bool isTime = std::find(std::begin(kTimeColumns), std::end(kTimeColumns), a.columns[c]) !=
                        std::end(kTimeColumns);
    if (isTime) continue;
    for (std::size_t r = 0; r < a.rows.size(); ++r)
      ASSERT_EQ(a.rows[r][c], b.rows[r][c]) << a.columns[c] << ", row " << r;
  }
}

TEST(SummaryFile, HasTheKeysOfTheInterfaceAndNoOthers) {
  const LoggedRun run(humanoidReach());
  ASSERT_EQ(run.outcome.exitCode, 0) << run.outcome.err;
  const Json j = run.json();
  using Keys = std::set<std::string>;
  EXPECT_EQ(keysOf(j), (Keys{"format",
                             "version",
                             "mechanisms",
                             "origin",
                             "verdict",
                             "bases",
                             "control_ratios",
                             "model",
                             "options",
                             "outcome",
                             "steps",
                             "state_hash",
                             "simulated_s",
                             "wall_s",
                             "real_time_factor",
                             "effects",
                             "time_us",
                             "constraints",
                             "iterations",
                             "dual_updates",
                             "physics_violation",
                             "gdd_violation",
                             "stationarity",
                             "realised",
                             "gdd_minima",
                             "fallbacks",
                             "goals",
                             "energy_J",
                             "max_penetration_m",
                             "max_control_ratio",
                             "warnings"}));
  EXPECT_EQ(keysOf(j["model"]), (Keys{"name", "links", "dof", "actuated", "mass_kg"}));
  EXPECT_EQ(keysOf(j["options"]),
            (Keys{"timestep_s", "integrator", "step_doubling", "tolerance", "cone",
                  "impedance_ratio", "exact_diagonal", "without", "gdd_solver", "control_cost"}));
  EXPECT_EQ(keysOf(j["time_us"]), (Keys{"forward", "gdd", "step"}));
  for (const char* stage : {"forward", "gdd", "step"})
    EXPECT_EQ(keysOf(j["time_us"][stage]), (Keys{"mean", "p50", "p95"})) << stage;
  for (const char* series : {"constraints", "iterations", "dual_updates", "physics_violation",
                             "gdd_violation", "stationarity", "realised"})
    EXPECT_EQ(keysOf(j[series]), (Keys{"p50", "p95", "max"})) << series;
  EXPECT_EQ(keysOf(j["energy_J"]), (Keys{"initial", "final"}));
  ASSERT_EQ(j["goals"].size(), 1u) << "damping is no place to be";
  EXPECT_EQ(keysOf(j["goals"][0]),
            (Keys{"name", "unit", "initial_error_m", "final_error_m", "best_error_m", "best_time_s",
                  "judged_at_s", "reached_within", "reached", "reason", "held_back_by"}));
}

TEST(SummaryFile, TellsTheRun) {
  const LoggedRun run(humanoidReach());
  ASSERT_EQ(run.outcome.exitCode, 0) << run.outcome.err;
  const Json j = run.json();
  EXPECT_EQ(j["model"]["name"], "humanoid");
  EXPECT_EQ(j["model"]["dof"], 27);
  EXPECT_EQ(j["model"]["actuated"], 21);
  EXPECT_NEAR(j["model"]["mass_kg"].get<double>(), 40.9, 0.05);
  EXPECT_EQ(j["outcome"], "completed");
  EXPECT_EQ(j["steps"], 50);
  EXPECT_NEAR(j["simulated_s"].get<double>(), 0.1, 1e-12);
  EXPECT_EQ(j["options"]["timestep_s"], 0.002);
  EXPECT_EQ(j["goals"][0]["name"], "reach right_hand");
  EXPECT_NEAR(j["goals"][0]["initial_error_m"].get<double>(), 0.432, 0.005);
  EXPECT_LE(j["physics_violation"]["p95"].get<double>(), 1e-8);
  EXPECT_LE(j["realised"]["p50"].get<double>(), j["realised"]["max"].get<double>());
  EXPECT_LE(j["max_control_ratio"].get<double>(), 1.0);
  EXPECT_GT(j["constraints"]["p50"].get<double>(), 0.0) << "it stands";
  for (const char* effect : {"gravity", "joint_limit", "ground_contact"})
    EXPECT_NE(std::find(j["effects"].begin(), j["effects"].end(), effect), j["effects"].end())
        << effect;
}

TEST(SummaryFile, MissingVisualMeshIsAmongTheWarnings) {
  const io::TempFolder folder;
  const std::string file = folder.write("ball.urdf", R"(<robot name="ball"><link name="ball">
    <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <visual><geometry><mesh filename="no_such.stl"/></geometry></visual>
    <collision><geometry><sphere radius="0.1"/></geometry></collision></link></robot>)");
  const LoggedRun run({file, "--passive", "--duration", "0.01"});
  ASSERT_EQ(run.outcome.exitCode, 0) << run.outcome.err;
  EXPECT_NE(run.json()["warnings"].dump().find("no_such.stl"), std::string::npos)
      << run.json()["warnings"];
}

TEST(Explain, TellsDofAndMassAndSimulatesNothing) {
  const io::TempFolder folder;
  const std::string log = folder.path() / "log.csv";
  struct Robot {
    const char* name;
    const char* dof;
    const char* mass;
  };
  for (const Robot& robot :
       {Robot{"humanoid", "27", "40.9"}, Robot{"hand", "30", "1.18"}, Robot{"arm", "7", "20.3"}}) {
    const Outcome outcome = simulate(
        {dataFile(std::string("robots/") + robot.name + ".urdf"), "--explain", "--log", log});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(robot.dof), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find(robot.mass), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("gravity"), std::string::npos) << outcome.out;
    EXPECT_FALSE(std::filesystem::exists(log));
  }
}

TEST(Table, EndsTheRunUnlessQuiet) {
  const std::vector<std::string> arguments = humanoidReach("0.02");
  const Outcome loud = simulate(arguments);
  EXPECT_EQ(loud.exitCode, 0);
  EXPECT_NE(loud.out.find("right_hand"), std::string::npos) << loud.out;
  EXPECT_EQ(loud.err, "") << "the progress bar is for terminals";
  std::vector<std::string> quiet = arguments;
  quiet.push_back("--quiet");
  const Outcome silent = simulate(quiet);
  EXPECT_EQ(silent.exitCode, 0);
  EXPECT_EQ(silent.out, "");
  EXPECT_EQ(silent.err, "");
}

TEST(Outputs, ATableIsNoOtherFormat) {
  const io::TempFolder folder;
  for (const auto& [option, file] : {std::pair{"--log", "run.JSON"}, {"--contacts", "run.mcap"}}) {
    const Outcome outcome = simulate({dataFile("robots/arm.urdf"), "--passive", "--duration",
                                      "0.01", option, folder.path() / file});
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_NE(outcome.err.find("run.csv"), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / file));
  }
}

}  // namespace
}  // namespace softgauss::test

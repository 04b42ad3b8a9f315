// SPDX-License-Identifier: Apache-2.0
/// Which integrator runs, how its error is controlled, and what the summary counts of it. Settings
/// that would change nothing are refused.

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

using Json = nlohmann::json;

/// A ball that falls on the ground, which divides steps.
std::string ball(const io::TempFolder& folder, const std::string& options = {}) {
  const std::string file = folder.path() / "ball.yaml";
  std::ofstream(file)
      << "name: ball\nobjects:\n"
         "  - {name: ball, sphere: {radius: 0.1}, mass: 1, position: [0, 0, 0.15]}\n"
      << (options.empty() ? "" : "options:\n" + options);
  return file;
}

Outcome run(const std::string& scene, std::vector<std::string> more, const std::string& summary) {
  std::vector<std::string> arguments{scene, "--passive", "--duration", "0.2", "--summary", summary};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return simulate(arguments);
}

struct ControlCase {
  std::string scene;  ///< its options
  std::vector<std::string> arguments;
  std::string expected;  ///< in the message, or the integrator
};

TEST(ErrorControl, RefusesWhatChangesNothing) {
  const std::string rk4 = "  integrator: runge-kutta-4\n";
  for (const ControlCase& c : std::vector<ControlCase>{
           {"", {"--step-doubling", "--integrator", "runge-kutta-4"}, "beside runge-kutta-4"},
           {"", {"--step-doubling", "--integrator", "dormand-prince"}, "beside dormand-prince"},
           {"",
            {"--step-doubling", "--integrator", "implicit-midpoint"},
            "beside implicit-midpoint"},
           {rk4, {"--step-doubling"}, "beside runge-kutta-4"},
           {"",
            {"--integration-tolerance", "1e-5", "--integrator", "semi-implicit-euler"},
            "--integration-tolerance changes nothing beside semi-implicit-euler"},
           {rk4, {"--integration-tolerance", "1e-5"}, "beside runge-kutta-4"},
           {"", {"--integration-tolerance", "0"}, "--integration-tolerance 0: expected"},
           {"", {"--integration-tolerance", "nan"}, "--integration-tolerance nan: expected"},
           {rk4 + "  step_doubling: true\n", {}, "ball.yaml:6: key 'options.step_doubling'"},
           {rk4 + "  integration_tolerance: 1e-5\n",
            {},
            "ball.yaml:6: key 'options.integration_tolerance': found '1e-5' beside integrator "
            "runge-kutta-4"}}) {
    const io::TempFolder folder;
    const std::string summary = folder.path() / "summary.json";
    const Outcome outcome = run(ball(folder, c.scene), c.arguments, summary);
    EXPECT_EQ(outcome.exitCode, 2) << c.expected;
    EXPECT_NE(outcome.err.find(c.expected), std::string::npos) << c.expected << " in\n"
                                                               << outcome.err;
    EXPECT_EQ(readFile(summary), "") << c.expected;
  }
}

// One thing alone does what it says; the command line is above the scene.
TEST(ErrorControl, FollowsFromWhatIsGiven) {
  const std::string tolerance = "  integration_tolerance: 1e-5\n",
                    doubled = "  step_doubling: true\n";
  for (const ControlCase& c : std::vector<ControlCase>{
           {"", {}, "leapfrog"},
           {"", {"--step-doubling"}, "leapfrog, doubled"},
           {"", {"--integration-tolerance", "1e-5"}, "dormand-prince"},
           {tolerance, {}, "dormand-prince"},
           {tolerance, {"--step-doubling"}, "leapfrog, doubled"},
           {tolerance + doubled, {}, "leapfrog, doubled"},
           {doubled, {"--integration-tolerance", "1e-5"}, "leapfrog, doubled"},
           {doubled, {"--integrator", "implicit"}, "implicit, doubled"},
           {doubled, {"--integrator", "runge-kutta-4"}, "runge-kutta-4, warned of step_doubling"},
           {tolerance,
            {"--integrator", "runge-kutta-4"},
            "runge-kutta-4, warned of integration_tolerance"}}) {
    const io::TempFolder folder;
    const std::string summary = folder.path() / "summary.json";
    const Outcome outcome = run(ball(folder, c.scene), c.arguments, summary);
    ASSERT_EQ(outcome.exitCode, 0) << c.expected << outcome.err;
    const Json json = Json::parse(readFile(summary));
    std::string found = json["options"]["integrator"];
    if (json["options"]["step_doubling"]) found += ", doubled";
    for (const Json& warning : json["warnings"])
      for (const char* key : {"step_doubling", "integration_tolerance"})
        if (warning.get<std::string>().find(key) == 0) found += std::string(", warned of ") + key;
    EXPECT_EQ(found, c.expected);
  }
}

// One evaluation a step that all begin with, then for each part that is tried: three of
// Runge-Kutta 4, six of Dormand-Prince, whose last is the next one's first, and three of a step
// that is doubled, the first of which is the step's own.
TEST(ErrorControl, IsCounted) {
  struct Law {
    const char* integrator;
    bool doubled;
    long ofStep, ofPart;
  };
  for (const Law& law : {Law{"runge-kutta-4", false, 1, 3}, Law{"dormand-prince", false, 1, 6},
                         Law{"implicit", true, 0, 3}}) {
    const io::TempFolder folder;
    const std::string summary = folder.path() / "summary.json";
    std::vector<std::string> arguments{"--integrator", law.integrator, "--details"};
    if (law.doubled) arguments.emplace_back("--step-doubling");
    const Outcome outcome = run(ball(folder), arguments, summary);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const Json json = Json::parse(readFile(summary)), counts = json["integration"];
    const long steps = json["steps"], parts = counts["substeps"], rejections = counts["rejections"];
    EXPECT_EQ(counts["evaluations"].get<long>(),
              law.ofStep * steps + law.ofPart * (parts + rejections))
        << law.integrator;
    const bool divides = law.doubled || std::string(law.integrator) == "dormand-prince";
    EXPECT_EQ(rejections > 0, divides) << law.integrator;
    EXPECT_EQ(parts > steps, divides) << law.integrator;
    const std::string told = std::to_string(rejections) + " more tried and rejected";
    EXPECT_NE(outcome.out.find(told), std::string::npos) << outcome.out;
  }
  // A step of one solve has nothing to count.
  const io::TempFolder folder;
  const std::string summary = folder.path() / "summary.json";
  ASSERT_EQ(run(ball(folder), {}, summary).exitCode, 0);
  EXPECT_FALSE(Json::parse(readFile(summary)).contains("integration"));
  // One that goes in parts has: what is tied turns by 0.1 rad a step.
  ASSERT_EQ(run(dataFile("scenes/stability/loop_5.yaml"), {"--timestep", "0.02"}, summary).exitCode,
            0);
  const Json loop = Json::parse(readFile(summary));
  EXPECT_GT(loop["integration"]["parts"], loop["steps"]);
}

// Where nobody names an integrator, what has goals moves as they have been solved.
TEST(ErrorControl, GoalsMoveAsSolvedByDefault) {
  for (const char* h : {"0.002", "0.01"}) {
    const io::TempFolder folder;
    const std::string summary = folder.path() / "summary.json";
    const Outcome outcome = simulate({dataFile("robots/humanoid.urdf"), "--goals",
                                      dataFile("goals/stand_and_reach.yaml"), "--duration", "1",
                                      "--timestep", h, "--summary", summary});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto json = nlohmann::json::parse(readFile(summary));
    EXPECT_EQ(json["options"]["integrator"], "leapfrog");
    EXPECT_LT(double{json["realised"]["p95"]}, 1e-9) << h;
  }
}

}  // namespace
}  // namespace softgauss::test

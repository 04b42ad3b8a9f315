// SPDX-License-Identifier: Apache-2.0
/// Scene files on the command line.

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

// SPDX-License-Identifier: Apache-2.0
/// Meshes, landscapes and the second source of contacts, on the command line.

#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

/// A tray of 1 m: a floor and four walls that lean outwards, as one closed surface.
const std::string kTray =
    "v -0.5 -0.5 0\nv 0.5 -0.5 0\nv 0.5 0.5 0\nv -0.5 0.5 0\n"
    "v -0.5 -0.5 0.4\nv 0.5 -0.5 0.4\nv 0.5 0.5 0.4\nv -0.5 0.5 0.4\n"
    "v -0.45 -0.45 0.05\nv 0.45 -0.45 0.05\nv 0.45 0.45 0.05\nv -0.45 0.45 0.05\n"
    "v -0.45 -0.45 0.4\nv 0.45 -0.45 0.4\nv 0.45 0.45 0.4\nv -0.45 0.45 0.4\n"
    "f 1 4 3 2\nf 9 10 11 12\n"
    "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"
    "f 10 9 13 14\nf 11 10 14 15\nf 12 11 15 16\nf 9 12 16 13\n"
    "f 5 6 14 13\nf 6 7 15 14\nf 7 8 16 15\nf 8 5 13 16\n";

/// Where a ball of 0.1 m ends that falls into the tray [m].
double heightOfBall(const std::string& tray, const std::vector<std::string>& options) {
  const io::TempFolder folder;
  folder.write("tray.obj", kTray);
  const std::string scene = folder.write(
      "scene.yaml", "ground: none\nobjects:\n  - {name: tray, mesh: {file: tray.obj}" + tray +
                        "}\n  - {name: ball, sphere: {radius: 0.1}, position: [0.1, "
                        "0.05, 0.7]}\n");
  const std::string log = folder.path() / "log.csv";
  std::vector<std::string> arguments = {scene, "--duration", "2", "--log", log, "--quiet"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = simulate(arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  const Csv csv((readFile(log)));
  return csv.number(static_cast<int>(csv.rows.size()) - 1, "q:ball.z");
}

TEST(Meshes, ATrayHoldsABallAndItsHullDoesNot) {
  const double onFloor = 0.15, onLid = 0.5;
  EXPECT_NEAR(heightOfBall(", fixed: true", {}), onFloor, 1e-3);
  EXPECT_NEAR(heightOfBall(", fixed: true", {"--meshes", "triangles"}), onFloor, 1e-3);
  EXPECT_NEAR(heightOfBall(", fixed: true", {"--collision", "fcl"}), onFloor, 1e-3);
  EXPECT_NEAR(heightOfBall(", fixed: true", {"--meshes", "hull"}), onLid, 1e-3);
  EXPECT_NEAR(heightOfBall(", fixed: true", {"--compatibility", "mujoco"}), onLid, 1e-3);
  EXPECT_NEAR(heightOfBall(", fixed: true, collide_as: hull", {"--meshes", "triangles"}), onLid,
              1e-3);
}

TEST(Meshes, AHullThatFillsWhatMovesIsTold) {
  const io::TempFolder folder;
  folder.write("tray.obj", kTray);
  const std::string scene =
      folder.write("scene.yaml", "objects: [{name: tray, mesh: {file: tray.obj}, mass: 2}]\n");
  const std::string summary = folder.path() / "summary.json";
  const auto warnings = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {scene,       "--duration", "0.1",
                                          "--summary", summary,      "--quiet"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = simulate(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return nlohmann::json::parse(readFile(summary))["warnings"].dump();
  };
  const std::string told = warnings({});
  for (const char* words : {"hull", "'tray'", "tray.obj", "l, hull 400 l"})
    EXPECT_NE(told.find(words), std::string::npos) << told;
  EXPECT_EQ(warnings({"--meshes", "triangles"}).find("hull"), std::string::npos);
  EXPECT_EQ(warnings({"--meshes", "hull"}).find("hull"), std::string::npos);
}

TEST(Meshes, ExplainCountsThem) {
  const Outcome outcome = simulate({dataFile("scenes/landscape.yaml"), "--explain"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("triangle mesh 1"), std::string::npos) << outcome.out;
}

// Sleepers are met as well where FCL finds the contacts.
TEST(Collision, FclMeetsWhoSleeps) {
  const io::TempFolder folder;
  const std::string scene =
      folder.write("scene.yaml",
                   "ground: 0\nobjects:\n"
                   "  - {name: box, box: {size: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 0, 0.1]}\n"
                   "  - {name: ball, sphere: {radius: 0.1}, mass: 1, position: [0, 0, 4]}\n");
  std::string woken[2];
  for (const bool fcl : {false, true}) {
    const Outcome outcome = simulate(
        {scene, "--duration", "1.5", "--sleep", "objects", "--collision", fcl ? "fcl" : "own"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const std::size_t at = outcome.out.find("  sleep: ");
    ASSERT_NE(at, std::string::npos) << outcome.out;
    woken[fcl] = outcome.out.substr(at, outcome.out.find('\n', at) - at);
  }
  for (const std::string& line : woken) {
    EXPECT_NE(line.find("up to 1 of 2 trees"), std::string::npos) << line;
    EXPECT_NE(line.find("1 woken"), std::string::npos) << line;
  }
}

TEST(Collision, ASceneMayAskForFcl) {
  const io::TempFolder folder;
  const std::string text = "objects: [{name: ball, sphere: {radius: 0.1}}]\ncollision: ";
  const std::string good = folder.write("good.yaml", text + "fcl\n");
  EXPECT_EQ(simulate({good, "--duration", "0.1", "--quiet"}).exitCode, 0);
  const Outcome bad = simulate({folder.write("bad.yaml", text + "bullet\n"), "--quiet"});
  EXPECT_EQ(bad.exitCode, 2);
  EXPECT_NE(bad.err.find("bad.yaml:2"), std::string::npos) << bad.err;
}

}  // namespace
}  // namespace softgauss::test

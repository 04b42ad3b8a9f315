// SPDX-License-Identifier: Apache-2.0
/// stability_report: its exit code says whether the hard cases of data/scenes/stability do what is
/// known of them.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

const std::string kScenes = dataFile("scenes/stability");

std::vector<std::string> arguments(const std::string& scenes,
                                   const std::vector<std::string>& only) {
  std::vector<std::string> list = {scenes, "--ours"};
  for (const std::string& scene : only) list.insert(list.end(), {"--only", scene});
  return list;
}

TEST(StabilityReport, QuickScenesHoldTheirBounds) {
  const Outcome outcome = runProgram(
      "stability_report",
      arguments(kScenes, {"boxes_1_on_1", "boxes_1000_on_1", "light_feet", "pendulum", "chain_10",
                          "top", "tumbling", "loop_1", "loop_2", "loop_5", "slope", "springs",
                          "gimbal", "tower_far", "tower_small", "tower_large", "sphere"}));
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("| 1000 kg on 1 kg | overlap at rest [mm] | 2 |"), std::string::npos);
}

TEST(StabilityReport, EverySceneDoesAsIsKnownLong) {
  const Outcome outcome = runProgram("stability_report", {kScenes});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
}

/// The exit code and errors of one scene, with `text` in place of its file.
Outcome withScene(const std::string& scene, const std::string& text) {
  const io::TempFolder folder;
  std::ofstream(std::filesystem::path(folder.path()) / (scene + ".yaml")) << text;
  return runProgram("stability_report", arguments(folder.path(), {scene}));
}

// A floor of foam: the sphere sinks by more than it may.
TEST(StabilityReport, AMissedBoundIsTold) {
  const Outcome outcome = withScene("sphere", R"(
ground: none
materials:
  foam: {time_constant: 0.1}
objects:
  - {name: floor, plane: {}, fixed: true, material: foam}
  - {name: ball, sphere: {radius: 0.1}, mass: 1, material: foam, position: [0, 0, 0.1]}
)");
  EXPECT_EQ(outcome.exitCode, 1);
  EXPECT_NE(outcome.err.find("sphere at rest, overlap at rest at 2 ms: misses its bound"),
            std::string::npos)
      << outcome.err;
}

TEST(StabilityReport, AMissingSceneEndsWithTwo) {
  const io::TempFolder folder;
  EXPECT_EQ(runProgram("stability_report", arguments(folder.path(), {"sphere"})).exitCode, 2);
}

}  // namespace
}  // namespace softgauss::test

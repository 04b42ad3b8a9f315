// SPDX-License-Identifier: Apache-2.0
/// Mechanisms of the step are counted where they act, in the summary, and can be left out.

#include "softgauss/engine/model/mechanisms.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

nlohmann::json summaryOf(std::vector<std::string> arguments) {
  const io::TempFolder folder;
  const std::string summary = folder.path() / "summary.json";
  arguments.insert(arguments.end(),
                   {"--passive", "--duration", "0.1", "--summary", summary, "--quiet"});
  const Outcome outcome = simulate(arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  return nlohmann::json::parse(readFile(summary));
}

// A scene that calls for it has it act; without it, it is not counted, and is listed as left out.
TEST(Mechanisms, ActWhereASceneCallsForThem) {
  const io::TempFolder folder;
  const std::string thrown = folder.write(
      "thrown.yaml",
      "ground: 0\n"
      "objects:\n"
      "  - {name: cube, box: {size: [0.1, 0.1, 0.1]}, mass: 1, position: [0, 0, 0.05],\n"
      "     velocity: [3, 0, 0]}\n");
  const auto hard = [](const std::string& name) {
    return dataFile("scenes/stability/" + name + ".yaml");
  };
  const std::map<std::string, std::string> scenes = {
      {"midpoint_velocity", hard("top_on_tip")},     {"substepping", hard("top_on_tip")},
      {"tree_substepping", hard("tumbling")},        {"near_rigid", hard("coin")},
      {"contact_bias_acceleration", hard("sphere")}, {"supported_mass", hard("boxes_1000_on_1")},
      {"stiction", hard("boxes_1000_on_1")},         {"slip_correction", thrown},
      {"geometric_stiffness", hard("rope")}};
  for (const MechanismName& mechanism : kMechanismNames) {
    const std::string name(mechanism.name);
    ASSERT_EQ(scenes.count(name), 1u) << name;
    const nlohmann::json with = summaryOf({scenes.at(name)});
    EXPECT_GT(with["mechanisms"][name], 0) << name;
    EXPECT_TRUE(with["options"]["without"].empty());
    const nlohmann::json without = summaryOf({scenes.at(name), "--without", name});
    EXPECT_FALSE(without["mechanisms"].contains(name)) << name;
    EXPECT_EQ(without["options"]["without"], nlohmann::json{name});
  }
}

// MuJoCo's step has none of them.
TEST(Mechanisms, AreNotMuJoCos) {
  const nlohmann::json summary =
      summaryOf({dataFile("scenes/stability/boxes_1000_on_1.yaml"), "--compatibility", "mujoco"});
  EXPECT_FALSE(summary.contains("mechanisms"));
}

}  // namespace
}  // namespace softgauss::test

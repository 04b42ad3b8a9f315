// SPDX-License-Identifier: Apache-2.0
/// compare_mujoco, where there is a MuJoCo to build it with.

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

const std::string kProgram = std::string(SOFTGAUSS_APP_DIR) + "/compare_mujoco";

int run(const std::string& arguments) {
  return WEXITSTATUS(std::system((kProgram + " " + arguments + " >/dev/null 2>&1").c_str()));
}

TEST(CompareMujoco, HumanoidMovesTheSameInBoth) {
  if (!std::filesystem::exists(kProgram)) GTEST_SKIP() << "built without MuJoCo";
  const io::TempFolder folder;
  const std::string file = folder.path() / "humanoid.json";
  ASSERT_EQ(run(dataFile("robots/humanoid.urdf") + " --duration 0.2 --json " + file), 0);
  const auto json = nlohmann::json::parse(readFile(file));
  // Rounding, amplified by the condition of M.
  for (const char* key :
       {"acceleration_difference", "acceleration_difference_same_contacts", "inverse_difference"})
    EXPECT_LT(json[key]["max"], 1e-9) << key;
  EXPECT_LT(json["state_difference_after_1s"], 1e-9);
  for (const char* key : {"step_us", "forward_us", "inverse_us"})
    for (const char* engine : {"ours", "mujoco", "ratio"}) EXPECT_GT(json[key][engine], 0.0);
  EXPECT_FALSE(json["mujoco_version"].get<std::string>().empty());
}

TEST(CompareMujoco, RefusesWhatItCannotRead) {
  if (!std::filesystem::exists(kProgram)) GTEST_SKIP() << "built without MuJoCo";
  EXPECT_EQ(run("no_such_robot.urdf"), 2);
  EXPECT_EQ(run(dataFile("robots/arm.urdf") + " --timestep 0"), 2);
  EXPECT_EQ(run("--help"), 0);
}

}  // namespace
}  // namespace softgauss::test

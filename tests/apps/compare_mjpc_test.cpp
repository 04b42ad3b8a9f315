// SPDX-License-Identifier: Apache-2.0
/// compare_mjpc, where there is a MuJoCo MPC to build it with.

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

const std::string kComparison = std::string(SOFTGAUSS_APP_DIR) + "/compare_mjpc";

// A swing up has one minimum from rest, in the steps of either engine: both planners find it, and
// find it again from the other's plan. The steps of 0.05 s differ by less than 1 % of its cost.
TEST(CompareMjpc, BothFindTheSameMinimum) {
  if (!std::filesystem::exists(kComparison)) GTEST_SKIP() << "built without MuJoCo MPC";
  const io::TempFolder folder;
  const std::string file = folder.path() / "race.json";
  const Outcome outcome = runProgram(
      "compare_mjpc", {dataFile("plans/cart_pole.yaml"), "--repeats", "1", "--json", file});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const auto race = nlohmann::json::parse(readFile(file))[0];
  const double ours = race["ours"].back()[1], ilqg = race["ilqg"].back()[1];
  EXPECT_NEAR(ilqg, ours, 0.01 * ours);
  EXPECT_NEAR(race["ilqg_from_ours"], ilqg, 1e-3 * ilqg);
  EXPECT_NEAR(race["ours_from_ilqg"], ours, 1e-3 * ours);
  EXPECT_LT(race["cost_difference"], 1e-9);
  for (const char* planner : {"ours", "ilqg"})
    for (std::size_t i = 1; i < race[planner].size(); ++i) {
      EXPECT_LE(race[planner][i - 1][0], race[planner][i][0]) << planner;
      EXPECT_GE(race[planner][i - 1][1], race[planner][i][1]) << planner;
    }
}

TEST(CompareMjpc, RefusesWhatItCannotPose) {
  if (!std::filesystem::exists(kComparison)) GTEST_SKIP() << "built without MuJoCo MPC";
  EXPECT_NE(runProgram("compare_mjpc", {"nowhere.yaml"}).exitCode, 0);
  const io::TempFolder folder;
  std::string text = readFile(dataFile("plans/cart_pole.yaml"));
  text.replace(text.find("cart_pole.urdf"), 14, dataFile("plans/cart_pole.urdf"));
  text.replace(text.find("velocity: 20}"), 13,
               "velocity: 20, points: {pole: {target: [0, 0, 1], weight: 1}}}");
  const std::string file = folder.write("points.yaml", text);
  const Outcome outcome = runProgram("compare_mjpc", {file});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("has terms of points"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0
/// compare_mujoco, where there is a MuJoCo to build it with.

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/apps/process.hpp"
#include "tests/io/sample_urdf.hpp"

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
  for (const char* key : {"acceleration_difference", "acceleration_difference_same_contacts",
                          "inverse_difference", "inverse_difference_same_contacts"})
    EXPECT_LT(json[key]["max"], 1e-9) << key;
  EXPECT_LT(json["state_difference_after_1s"], 1e-9);
  for (const char* key : {"step_us", "forward_us", "inverse_us"})
    for (const char* engine : {"ours", "mujoco", "ratio"}) EXPECT_GT(json[key][engine], 0.0);
  for (const char* mode : {"compatibility", "default"})
    for (const char* engine : {"ours", "mujoco", "ratio"})
      EXPECT_GT(json["run_step_us"][mode][engine], 0.0);
  EXPECT_TRUE(json["mujoco_build"].get<std::string>().starts_with("MuJoCo "));
  // MuJoCo finds principal axes to eight digits, and takes massless links for 10⁻¹² kg.
  const auto& reading = json["urdf_reading"];
  ASSERT_FALSE(reading.contains("refused")) << reading["refused"];
  EXPECT_TRUE(reading["differs"].empty()) << reading["differs"];
  for (const char* key :
       {"total_mass", "body_mass", "centre_of_mass_m", "inertia", "joint_axis", "joint_range",
        "damping", "body_position_m", "mass_matrix", "smooth_acceleration", "inverse_weight"})
    EXPECT_LT(reading[key], 1e-7) << key;
  EXPECT_EQ(reading["shapes"], reading["shapes_ours"]);
  EXPECT_LT(json["mujoco_imbalance"]["max"], 1e-10);
  EXPECT_FALSE(json["mujoco_version"].get<std::string>().empty());
}

// What MuJoCo reads otherwise is told: a range of a continuous joint, a mimic joint.
TEST(CompareMujoco, TellsWhatMujocoReadsOtherwise) {
  if (!std::filesystem::exists(kProgram)) GTEST_SKIP() << "built without MuJoCo";
  const io::TempFolder folder;
  const std::string follower =
      "<link name=\"tip\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
      "iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link><joint name=\"wrist\" "
      "type=\"continuous\"><parent link=\"arm\"/><child link=\"tip\"/><axis xyz=\"1 0 "
      "0\"/><mimic joint=\"shoulder\"/></joint></robot>";
  const std::string file = folder.write(
      "robot.urdf", io::with(io::with(io::kSampleUrdf, "type=\"revolute\"", "type=\"continuous\""),
                             "</robot>", follower));
  const std::string figures = folder.path() / "figures.json", copy = folder.path() / "copy";
  ASSERT_EQ(run(file + " --duration 0.01 --json " + figures + " --write-copy " + copy), 0);
  const auto reading = nlohmann::json::parse(readFile(figures))["urdf_reading"];
  ASSERT_EQ(reading["differs"].size(), 1u) << reading;
  EXPECT_EQ(reading["differs"][0], "joint 'shoulder': MuJoCo reads a range -1 .. 1.5, ours none");
  EXPECT_EQ(reading["not_read"][0], "mimic of joint 'wrist': carried over as an equality");
  const std::string text = readFile(copy + "/robot.urdf");
  EXPECT_NE(text.find("type=\"floating\""), std::string::npos) << text;
  EXPECT_NE(text.find("<link name=\"world\"/>"), std::string::npos) << text;
}

// Each row of the table has two times, of steps that end at about the same state: MuJoCo's error is
// of first order, and its contacts are softer.
TEST(CompareMujoco, TableTimesTheSameMotionOfBoth) {
  if (!std::filesystem::exists(kProgram)) GTEST_SKIP() << "built without MuJoCo";
  const io::TempFolder folder;
  const std::string figures = folder.path() / "figures.json", table = folder.path() / "table.md";
  ASSERT_EQ(run("--table --quick --robots " + dataFile("robots") + " --json " + figures +
                " --out " + table + " " + folder.write("sample.urdf", io::kSampleUrdf).string()),
            0);
  const auto json = nlohmann::json::parse(readFile(figures));
  const std::string text = readFile(table);
  std::set<std::string> names;
  for (const auto& row : json["rows"]) {
    const std::string name = row["name"];
    names.insert(name.substr(0, name.find(" (")));
    EXPECT_FALSE(row.contains("refused")) << row;
    for (const char* key : {"mujoco_us", "ours_us", "ratio"})
      EXPECT_GT(row.value(key, 0.0), 0.0) << name;
    EXPECT_LT(row.value("apart_m", 0.0), 1e-2) << name;
    EXPECT_NE(text.find("| " + name + " | "), std::string::npos) << name;
  }
  for (const char* name :
       {"humanoid moving", "humanoid at rest", "humanoid held by torques", "hand", "arm",
        "chain of 30 links on the ground", "chain of 10 links swinging freely",
        "chain of 10 links swinging, at equal error", "27 capsules that fall apart", "pile of 10",
        "10 boxes at rest", "inverse dynamics, arm", "arm reaching, with its control",
        "sample held by torques", "sample swung by torques"})
    EXPECT_TRUE(names.contains(name)) << name;
  ASSERT_FALSE(json["curves"].empty());
  EXPECT_EQ(json["curves"][0]["sizes"], nlohmann::json({10, 30}));
  EXPECT_GT(json["curves"][0]["ours_exponent"], 0.0);
  EXPECT_NE(text.find("MuJoCo "), std::string::npos);
}

// Where the engines part there is no figure but the reason: two hinges that are whirled.
TEST(CompareMujoco, TableHasNoFigureWhereMotionsPart) {
  if (!std::filesystem::exists(kProgram)) GTEST_SKIP() << "built without MuJoCo";
  const io::TempFolder folder;
  std::string urdf = "<robot name=\"whip\"><link name=\"world\"/>";
  for (const std::string parent : {"world", "a"}) {
    const std::string name = parent == "a" ? "b" : "a";
    urdf += "<link name=\"" + name +
            "\"><inertial><origin xyz=\"0.3 0 0\"/><mass value=\"0.1\"/><inertia ixx=\"1e-3\" "
            "ixy=\"0\" ixz=\"0\" iyy=\"1e-3\" iyz=\"0\" izz=\"1e-3\"/></inertial></link><joint "
            "name=\"to_" +
            name + "\" type=\"continuous\"><parent link=\"" + parent + "\"/><child link=\"" + name +
            "\"/><origin xyz=\"0.3 0 0\"/><axis xyz=\"0 1 0\"/><limit effort=\"100\" "
            "velocity=\"1000\"/></joint>";
  }
  const std::string file = folder.write("whip.urdf", urdf + "</robot>");
  const std::string figures = folder.path() / "figures.json";
  ASSERT_EQ(run("--table --quick --only swung " + file + " --robots " + dataFile("robots") +
                " --json " + figures),
            0);
  const auto rows = nlohmann::json::parse(readFile(figures))["rows"];
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_FALSE(rows[0].contains("ours_us"));
  EXPECT_NE(rows[0].value("refused", "").find("the engines part"), std::string::npos) << rows;
}

TEST(CompareMujoco, TableRefusesWhatItCannotRead) {
  if (!std::filesystem::exists(kProgram)) GTEST_SKIP() << "built without MuJoCo";
  EXPECT_EQ(run("--table no_such_robot.urdf --robots " + dataFile("robots")), 2);
  EXPECT_EQ(run("--table --only '(' --robots " + dataFile("robots")), 2);
  EXPECT_EQ(run("--quick " + dataFile("robots/arm.urdf")), 2);
  EXPECT_EQ(run(""), 2);
}

TEST(CompareMujoco, RefusesWhatItCannotRead) {
  if (!std::filesystem::exists(kProgram)) GTEST_SKIP() << "built without MuJoCo";
  EXPECT_EQ(run("no_such_robot.urdf"), 2);
  EXPECT_EQ(run(dataFile("robots/arm.urdf") + " --timestep 0"), 2);
  EXPECT_EQ(run("--help"), 0);
}

}  // namespace
}  // namespace softgauss::test

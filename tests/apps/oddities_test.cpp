// SPDX-License-Identifier: Apache-2.0
/// What no robot does is told while the run goes on, and at its end.

#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

/// A hinge of a small inertia; `limit`: what stands in its <limit>.
std::string finger(const std::string& type, const std::string& limit) {
  return R"(<robot name="finger"><link name="world"/><link name="tip"><inertial>
    <mass value="0.001"/><inertia ixx="1.5e-7" iyy="1.5e-7" izz="1.5e-7" ixy="0" ixz="0" iyz="0"/>
    </inertial></link><joint name="knuckle" type=")" +
         type + R"("><parent link="world"/><child link="tip"/><axis xyz="0 0 1"/><limit )" + limit +
         R"( velocity="2"/></joint></robot>)";
}

struct OddRun {
  OddRun(const std::string& model, const std::string& extension,
         std::vector<std::string> arguments) {
    const std::string summary = folder.path() / "summary.json";
    arguments.insert(arguments.begin(), folder.write("model" + extension, model));
    arguments.insert(arguments.end(), {"--summary", summary});
    for (std::string& a : arguments)
      if (a == "torques.csv") a = folder.write(a, "time_s,u:knuckle\n0,0.01\n");
    outcome = simulate(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    verdict = nlohmann::json::parse(readFile(summary))["verdict"].dump();
  }
  void expectTold(const std::string& part) const {
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << "\n" << outcome.err;
    EXPECT_NE(verdict.find(part), std::string::npos) << part << "\n" << verdict;
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << "\n" << outcome.out;
    EXPECT_NE(outcome.err.find("t = "), std::string::npos) << "told at its time";
    EXPECT_NE(outcome.err.find("try "), std::string::npos) << "what to do";
  }
  io::TempFolder folder;
  Outcome outcome;
  std::string verdict;
};

// 0.01 N m on 1.5e-7 kg m²: 67,000 rad/s², past 3000 rad/s after 45 ms.
TEST(Oddities, ASpeedThatNoJointHasIsTold) {
  const OddRun run(finger("continuous", "effort=\"1\""), ".urdf",
                   {"--torques", "torques.csv", "--duration", "0.2"});
  run.expectTold("joint 'knuckle' moves at");
  EXPECT_EQ(run.outcome.err.find("moves at", run.outcome.err.find("moves at") + 1),
            std::string::npos)
      << "once";
}

// Overlapping by half its height, the box leaves the ground with energy that came from nowhere.
TEST(Oddities, EnergyOfAPassiveSceneIsTold) {
  const OddRun run(
      R"(objects: [{name: box, box: {size: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 0, 0.02]}]
ground: {height: 0}
)",
      ".yaml", {"--duration", "0.3"});
  run.expectTold("without a source");
}

TEST(Oddities, NothingIsToldWhereNothingIsOdd) {
  for (const char* robot : {"humanoid", "hand", "arm"}) {
    const Outcome outcome = simulate(
        {dataFile(std::string("robots/") + robot + ".urdf"), "--passive", "--duration", "1"});
    EXPECT_EQ(outcome.err.find("t = "), std::string::npos) << robot << ": " << outcome.err;
    EXPECT_EQ(outcome.out.find("implausible"), std::string::npos) << outcome.out;
  }
}

}  // namespace
}  // namespace softgauss::test

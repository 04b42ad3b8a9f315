// SPDX-License-Identifier: Apache-2.0
/// What --accuracy of simulate_gdd refuses, and says.

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

TEST(Accuracy, IsALength) {
  for (const char* accuracy : {"nan", "inf", "-1", "0"}) {
    std::vector<std::string> arguments = passiveArm("0.1");
    arguments.insert(arguments.end(), {"--accuracy", accuracy});
    const Outcome outcome = simulate(arguments);
    EXPECT_EQ(outcome.exitCode, 2);
    EXPECT_NE(outcome.err.find("expected metres of error above 0"), std::string::npos)
        << outcome.err;
  }
}

TEST(Accuracy, ChoosesTheSettingItself) {
  for (const std::vector<std::string>& given : {std::vector<std::string>{"--timestep", "0.001"},
                                                {"--integrator", "runge-kutta-4"},
                                                {"--step-doubling"}}) {
    std::vector<std::string> arguments = passiveArm("0.1");
    arguments.insert(arguments.end(), {"--accuracy", "1e-3"});
    arguments.insert(arguments.end(), given.begin(), given.end());
    EXPECT_EQ(simulate(arguments).exitCode, 2) << given[0];
  }
}

// No two runs of a humanoid that falls on the ground agree to a nanometre: it says so.
TEST(Accuracy, DoesNotPromiseWhatCannotBeKept) {
  const Outcome outcome = simulate({dataFile("robots/humanoid.urdf"), "--passive", "--duration",
                                    "0.1", "--base-height", "0.91", "--accuracy", "1e-14"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_EQ(outcome.err.rfind("simulate_gdd: --accuracy 1e-14: cannot be promised", 0), 0u)
      << outcome.err;
}

// What overflows is said to do so, and when; it does not take too long.
TEST(Accuracy, TellsOverflow) {
  const io::TempFolder folder;
  const std::string torques =
      folder.write("torques.csv", "time_s,u:shoulder_yaw,u:elbow_pitch\n0,1e12,-1e12\n");
  const Outcome outcome = simulate(
      {dataFile("robots/arm.urdf"), "--torques", torques, "--duration", "1", "--accuracy", "1e-3"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("become non-finite, the first at t = "), std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0
/// Servos of a whole simulation: told by goals, and by their user.

#include <gtest/gtest.h>

#include <algorithm>

#include "softgauss/io/simulation/simulation.hpp"
#include "tests/io/temp_folder.hpp"
#include "tests/simulation/data_file.hpp"

namespace softgauss::test {
namespace {

const char* const kServos = "{servo: {kp: 100, kd: 10}}";

/// The arm with servos on all its joints.
std::string armWithServos() {
  std::string text =
      "robots:\n  - urdf: " + robot("arm") + "\n    base: fixed\n    joint_parameters:\n";
  const Model model = Simulation::load(robot("arm")).model();
  for (const std::string& joint : model.jointNames)
    if (!joint.empty()) text += "      " + joint + ": " + kServos + "\n";
  return text;
}

// What a drive would be told under goals makes the same motion where it is told that and no goal
// acts, where no spring is too stiff for the step. No joint has friction, which would be softer
// under goals.
TEST(Simulation, SetPointsOfGoalsMakeTheirMotion) {
  const io::TempFolder folder;
  const auto file = folder.write("arm.yaml", armWithServos());
  Simulation goals = Simulation::load(file), drives = Simulation::load(file);
  goals.goals.reach("hand", {0.5, 0.2, 0.4});
  double moved = 0.0;
  for (int i = 0; i < 500; ++i) {
    ASSERT_FALSE(isRefused(goals.step()));
    for (const std::string& joint : goals.model().jointNames)
      if (!joint.empty()) drives.setSetPoint(joint, goals.setPoint(joint));
    ASSERT_FALSE(isRefused(drives.step()));
    // 1e-12 of a solve, times kp: forces differ by 1e-9 and the motion by less.
    EXPECT_NEAR((goals.state().q - drives.state().q).cwiseAbs().maxCoeff(), 0.0, 1e-9) << i;
    moved = std::max(moved, goals.state().q.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(moved, 0.1);
}

TEST(Simulation, ServosAreToldBySetPoints) {
  const io::TempFolder folder;
  Simulation sim = Simulation::load(folder.write("arm.yaml", armWithServos()));
  const std::string joint = sim.model().jointNames.back();
  sim.setSetPoint(joint, 0.3);
  sim.run(3.0);
  // It bears its link's weight by its spring; told that it does, it says so.
  EXPECT_NEAR(sim.setPoint(joint), 0.3, 1e-6);
  EXPECT_NEAR(sim.torque(joint), 100.0 * (0.3 - sim.position(joint)), 1e-6);
  Simulation motor = Simulation::load(robot("arm"));
  try {
    motor.setSetPoint(joint, 0.0);
    ADD_FAILURE();
  } catch (const NameError& error) {
    EXPECT_EQ(error.what(),
              "joint '" + joint + "' has no servo; give it one in the scene's joint_parameters");
  }
}

}  // namespace
}  // namespace softgauss::test

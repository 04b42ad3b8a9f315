// SPDX-License-Identifier: Apache-2.0
/// A robot that stands goes on standing beside a reach: on four and on six legs a foot is lifted
/// and the base stays level; what cannot be done so waits.
#include "softgauss/gdd/goals/standing_balance.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "softgauss/io/simulation/simulation.hpp"
#include "tests/io/temp_folder.hpp"
#include "tests/simulation/data_file.hpp"

namespace softgauss::test {
namespace {

std::string linkText(const std::string& name, double mass, double inertia, const char* at,
                     const std::string& shape) {
  return fmt::format(
      "<link name=\"{}\"><inertial><origin xyz=\"{}\"/><mass value=\"{}\"/>"
      "<inertia ixx=\"{}\" iyy=\"{}\" izz=\"{}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>{}"
      "</link>\n",
      name, at, mass, inertia, inertia, inertia,
      shape.empty() ? "" : "<collision><geometry>" + shape + "</geometry></collision>");
}

std::string jointText(const std::string& name, const std::string& parent, const std::string& child,
                      const std::string& origin, const char* axis) {
  return fmt::format(
      "<joint name=\"{}\" type=\"{}\"><parent link=\"{}\"/><child link=\"{}\"/><origin {}/>"
      "<axis xyz=\"{}\"/><limit lower=\"-1.5\" upper=\"1.5\" effort=\"12\" velocity=\"10\"/>"
      "<dynamics damping=\"0.02\"/></joint>\n",
      name, name.ends_with("ankle") ? "fixed" : "revolute", parent, child, origin, axis);
}

/// A trunk on bent legs of three hinges each, which end in balls, evenly around it.
std::string walker(int legs) {
  std::string urdf =
      "<robot name=\"walker\">\n" +
      linkText("trunk", 2.5, 0.02, "0 0 0", "<cylinder radius=\"0.12\" length=\"0.06\"/>");
  for (int i = 0; i < legs; ++i) {
    const std::string leg = fmt::format("leg{}_", i);
    const double angle = 2.0 * M_PI * (i + 0.5) / legs;
    urdf += linkText(leg + "coxa", 0.1, 1e-4, "0.025 0 0", "") +
            linkText(leg + "thigh", 0.2, 4e-4, "0.06 0 0", "") +
            linkText(leg + "shin", 0.15, 4e-4, "0 0 -0.09", "") +
            linkText(leg + "foot", 0.03, 1e-5, "0 0 0", "<sphere radius=\"0.02\"/>");
    urdf += jointText(leg + "yaw", "trunk", leg + "coxa",
                      fmt::format("xyz=\"{} {} 0\" rpy=\"0 0 {}\"", 0.12 * std::cos(angle),
                                  0.12 * std::sin(angle), angle),
                      "0 0 1") +
            jointText(leg + "hip", leg + "coxa", leg + "thigh", "xyz=\"0.05 0 0\" rpy=\"0 -0.5 0\"",
                      "0 1 0") +
            jointText(leg + "knee", leg + "thigh", leg + "shin", "xyz=\"0.13 0 0\" rpy=\"0 0.5 0\"",
                      "0 1 0") +
            jointText(leg + "ankle", leg + "shin", leg + "foot", "xyz=\"0 0 -0.18\"", "1 0 0");
  }
  return urdf + "</robot>\n";
}

class StandingBalance : public ::testing::Test {
 protected:
  Simulation load(int legs, const SimulationOptions& options = {}) {
    const std::string file = (folder.path() / "walker.urdf").string();
    std::ofstream(file) << walker(legs);
    return Simulation::load(file, options);
  }

  io::TempFolder folder;
};

double tilt(Simulation& sim, const char* base) {
  return std::acos(std::min(1.0, sim.pose(base).R(2, 2)));
}

TEST_F(StandingBalance, AFootIsLiftedOnFourAndSixLegs) {
  for (const int legs : {4, 6}) {
    Simulation sim = load(legs);
    const double height = sim.pose("trunk").p.z();
    const Vector3 place = sim.pose("leg0_foot").p + Vector3(0.02, 0.0, 0.07);
    sim.goals.reach("leg0_foot", place);
    double most = 0.0;
    for (int i = 0; i < 40; ++i) {
      sim.run(0.1);
      most = std::max(most, tilt(sim, "trunk"));
    }
    EXPECT_LT((sim.pose("leg0_foot").p - place).norm(), 1e-3) << legs;
    // Half a degree; a trunk that leans on the rest of its legs has several.
    EXPECT_LT(most, M_PI / 360.0) << legs;
    EXPECT_LT(std::abs(sim.pose("trunk").p.z() - height), 2e-3) << legs;
    EXPECT_LT(sim.state().v.cwiseAbs().maxCoeff(), 0.05) << legs;
  }
}

// A foot that is told to go into the ground would lift the trunk, one that is the only one left but
// one would throw it over.
TEST_F(StandingBalance, WhatWouldThrowItOverWaits) {
  Simulation sim = load(6);
  sim.goals.reach("leg0_foot", sim.pose("leg0_foot").p - Vector3(0.0, 0.0, 0.05));
  sim.run(2.0);
  EXPECT_LT(tilt(sim, "trunk"), M_PI / 360.0);

  Simulation humanoid = Simulation::load(robot("humanoid"));
  const Vector3 foot = humanoid.pose("right_foot").p;
  humanoid.goals.reach("right_foot", foot + Vector3(0.1, 0.0, 0.12));
  humanoid.run(2.0);
  EXPECT_LT(tilt(humanoid, "pelvis"), M_PI / 360.0);
  EXPECT_LT((humanoid.pose("right_foot").p - foot).norm(), 1e-3);
}

/// Whether the humanoid stands after 6 s in which the link sought the place.
bool stands(const std::string& link, const Vector3& place) {
  Simulation sim = Simulation::load(robot("humanoid"));
  const double height = sim.pose("pelvis").p.z();
  sim.goals.reach(link, place);
  sim.run(6.0);
  // On the ground the pelvis is 0.1 m high; at rest on bent legs no lower than 0.5 m.
  return sim.pose("pelvis").p.z() > 0.55 * height && tilt(sim, "pelvis") < M_PI / 4.0;
}

// A place beyond reach pulls for good: no weight of the balance holds against that. The goal fades
// instead, and posture and feet hold the robot.
TEST_F(StandingBalance, PlacesOutOfReachThrowNothingOver) {
  EXPECT_TRUE(stands("right_hand", {1.5, -0.2, 1.1})) << "far in front";
  EXPECT_TRUE(stands("right_hand", {0.3, -0.2, 0.1})) << "by the feet";
  EXPECT_TRUE(stands("right_hand", {0.4, -0.2, 1.8})) << "above the head";
}

// What a robot does that is about to fall is its own: the goals of one beside it do not fade.
TEST_F(StandingBalance, FadesGoalsOfItsOwnRobotOnly) {
  const std::string urdf = robot("humanoid");
  const std::string scene = (folder.path() / "two.yaml").string();
  std::ofstream(scene) << fmt::format(
      "robots:\n- {{name: a, urdf: {0}}}\n- {{name: b, urdf: {0}, position: [0, 3, 0]}}\n", urdf);
  Simulation sim = Simulation::load(scene);
  gdd::Goal& far = sim.goals.reach("a/right_hand", {2.5, 0.0, 1.1});
  gdd::Goal& near = sim.goals.reach("b/right_hand", sim.pose("b/right_hand").p);
  sim.step();
  const gdd::GoalContext context{sim.model(), sim.state(), sim.data()};
  int balances = 0;
  for (std::size_t i = 0; i < sim.goals.size(); ++i) {
    const auto* balance = dynamic_cast<const gdd::StandingBalance*>(&sim.goals[i]);
    if (!balance) continue;
    const bool isOfA = balance->X_WBase.p.y() < 1.5;
    EXPECT_EQ(balance->share(context, {}, isOfA ? near : far), 1.0);
    if (isOfA) {
      EXPECT_LT(balance->share(context, {}, far), 0.2);
    }
    ++balances;
  }
  EXPECT_EQ(balances, 2);
}

// Twenty places in a box as large as the robot, more than half of them beyond its reach. That none
// falls is no law: a robot at the ends of its joints may. Without fading 11 fell.
TEST_F(StandingBalance, PlacesAnywhereThrowNothingOverLong) {
  std::mt19937 random(7);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  int fallen = 0;
  for (int i = 0; i < 20; ++i) {
    const double x = between(-0.3, 1.0), y = between(-0.8, 0.5), z = between(0.2, 1.8);
    fallen += !stands("right_hand", {x, y, z});
  }
  EXPECT_LE(fallen, 2);
}

TEST_F(StandingBalance, ComesWithAReachOfWhatStandsAndIsLeftOutOnDemand) {
  const auto balances = [](Simulation& sim) {
    int count = 0;
    for (std::size_t i = 0; i < sim.goals.size(); ++i)
      count += dynamic_cast<gdd::StandingBalance*>(&sim.goals[i]) != nullptr;
    return count;
  };
  Simulation standing = load(4);
  standing.goals.posture();
  EXPECT_EQ(balances(standing), 0);
  standing.goals.reach("trunk", standing.pose("trunk").p);
  EXPECT_EQ(balances(standing), 1);

  SimulationOptions without;
  without.noBalance = true;
  Simulation asked = load(4, without);
  asked.goals.reach("trunk", asked.pose("trunk").p);
  EXPECT_EQ(balances(asked), 0);

  SimulationOptions high;
  high.baseHeight = 1.0;
  Simulation falling = load(4, high);
  falling.goals.reach("trunk", falling.pose("trunk").p);
  EXPECT_EQ(balances(falling), 0);

  Simulation arm = Simulation::load(robot("arm"));
  arm.goals.reach("hand", Vector3(0.5, 0.2, 0.4));
  EXPECT_EQ(balances(arm), 0);
}

}  // namespace
}  // namespace softgauss::test

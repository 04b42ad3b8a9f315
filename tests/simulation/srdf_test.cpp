// SPDX-License-Identifier: Apache-2.0
/// States and links that never collide, of the SRDF of a robot; how it stands at the start.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "softgauss/engine/engine.hpp"
#include "softgauss/engine/model/model_hash.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "tests/simulation/data_file.hpp"
#include "tests/simulation/quadruped.hpp"

namespace softgauss::test {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;

/// Pairs of links that are tested against each other, each in order.
Pairs testedPairs(const Scene& scene) {
  Pairs pairs;
  for (const collision::GeometryPair& pair : scene.contacts->filter().pairs)
    pairs.push_back(std::minmax(scene.model.geometries[static_cast<std::size_t>(pair.a)].link,
                                scene.model.geometries[static_cast<std::size_t>(pair.b)].link));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

double position(const Scene& scene, const std::string& joint) {
  return scene.initial.q[scene.model.bodies[idx(scene.model.findJoint(joint))].q];
}

bool warns(const Scene& scene, const std::string& words) {
  return std::any_of(scene.model.warnings.begin(), scene.model.warnings.end(),
                     [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

SimulationOptions inState(const std::string& state) {
  SimulationOptions options;
  options.state = state;
  return options;
}

// Four entrances: the state of the package's SRDF, of one that is named, its positions by q0, the
// key of a scene.
TEST(SrdfState, IsTheStartByItsPositions) {
  const QuadrupedPackage package;
  const auto found = loadScene(package.urdf, inState("standing"));
  SimulationOptions named = inState("standing");
  named.srdf = package.srdf;
  const auto byName = loadScene(package.urdf, named);
  SimulationOptions positions;
  for (const std::string leg : {"FL", "FR", "RL", "RR"}) {
    positions.q0.emplace_back(leg + "_hip", 0.7);
    positions.q0.emplace_back(leg + "_knee", -1.4);
  }
  const auto byPositions = loadScene(package.urdf, positions);
  const auto scene = loadScene(
      package.folder.write("scene.yaml", "robots: [{urdf: urdf/quadruped.urdf, state: standing}]"));
  EXPECT_EQ(position(*found, "FL_hip"), 0.7);
  EXPECT_EQ(hash(found->initial), hash(byPositions->initial));
  EXPECT_EQ(hash(found->initial), hash(byName->initial));
  EXPECT_EQ(hash(found->initial), hash(scene->initial));
  // Hips at 0.7, knees bent back by 1.4: feet below hips, 0.4 cos 0.7 lower, and a radius.
  EXPECT_NEAR(found->initial.q[2], 0.4 * std::cos(0.7) + 0.02, 1e-12);
  EXPECT_FALSE(warns(*found, "state"));
  EXPECT_NE(std::find(found->contents.files.begin(), found->contents.files.end(), package.srdf),
            found->contents.files.end());
  ASSERT_EQ(found->notes.size(), 1u);
  EXPECT_NE(found->notes[0].find("standing, kneeling, mixed"), std::string::npos)
      << found->notes[0];
  EXPECT_NE(found->notes[0].find("2 pairs of links never collide"), std::string::npos)
      << found->notes[0];
  EXPECT_TRUE(byName->notes.empty());
}

TEST(SrdfState, GivesWayToPositionsThatAreNamed) {
  const QuadrupedPackage package;
  SimulationOptions options = inState("standing");
  options.q0 = {{"FR_knee", -1.0}};
  const auto scene = loadScene(package.urdf, options);
  EXPECT_EQ(position(*scene, "FR_knee"), -1.0);
  EXPECT_EQ(position(*scene, "FL_knee"), -1.4);
  const auto file = loadScene(package.folder.write(
      "scene.yaml",
      "robots: [{name: a, urdf: urdf/quadruped.urdf, state: mixed, joints: {FR_knee: -1.0}},\n"
      "         {name: b, urdf: urdf/quadruped.urdf, state: rear/mixed, position: [2, 0, 1]}]"));
  EXPECT_EQ(position(*file, "a/FR_knee"), -1.0);
  EXPECT_EQ(position(*file, "a/FR_hip"), 0.7);
  EXPECT_EQ(position(*file, "a/RR_hip"), 0.6);
  EXPECT_EQ(position(*file, "b/RR_hip"), 0.6);
  EXPECT_EQ(position(*file, "b/FR_hip"), 0.0);
}

TEST(SrdfState, KeepsRangesAndLeadersAndLeavesOutWhatIsNotThere) {
  const QuadrupedPackage package;
  std::string urdf = quadruped();
  const std::string joint = "<joint name='RR_knee' type='revolute'>";
  urdf.replace(urdf.find(joint), joint.size(),
               joint + "<mimic joint='RL_knee' multiplier='0.5' offset='-0.25'/>");
  package.folder.write("urdf/quadruped.urdf", urdf);
  package.folder.write("srdf/quadruped.srdf",
                       "<robot name='quadruped'><group_state name='x' group='all'>"
                       "<joint name='FL_hip' value='2.5'/><joint name='RL_knee' value='-1'/>"
                       "<joint name='RR_knee' value='-1'/><joint name='tail' value='1'/>"
                       "</group_state></robot>");
  const auto scene = loadScene(package.urdf, inState("x"));
  EXPECT_EQ(position(*scene, "FL_hip"), 2.0);
  EXPECT_EQ(position(*scene, "RL_knee"), -1.0);
  EXPECT_EQ(position(*scene, "RR_knee"), -0.75);
  EXPECT_TRUE(warns(*scene, "FL_hip from 2.5 to 2")) << scene->model.warnings.size();
  EXPECT_TRUE(warns(*scene, "RR_knee from -1 to -0.75"));
  EXPECT_TRUE(warns(*scene, "no joints of these names: tail"));
}

// All else is tested as before, in a scene, and in one of two robots too.
TEST(SrdfApart, PairsAreNeverTestedAndOthersAre) {
  const QuadrupedPackage package;
  SimulationOptions without;
  without.srdf = "none";
  const auto with = loadScene(package.urdf), plain = loadScene(package.urdf, without);
  EXPECT_TRUE(plain->model.apart.empty());
  const Pairs tested = testedPairs(*with), all = testedPairs(*plain);
  Pairs expected;
  for (const auto& pair : all)
    if (pair != std::pair<std::string, std::string>{"FL_calf", "FR_calf"} &&
        pair != std::pair<std::string, std::string>{"FL_foot", "FR_foot"})
      expected.push_back(pair);
  EXPECT_EQ(expected.size(), all.size() - 2);
  EXPECT_EQ(tested, expected);
  const auto two = loadScene(package.folder.write(
      "two.yaml",
      "robots: [{name: a, urdf: urdf/quadruped.urdf},\n"
      "         {name: b, urdf: urdf/quadruped.urdf, srdf: none, position: [2, 0, 1]}]"));
  const Pairs both = testedPairs(*two);
  const auto has = [&](const char* a, const char* b) {
    return std::find(both.begin(), both.end(), std::pair<std::string, std::string>(a, b)) !=
           both.end();
  };
  EXPECT_FALSE(has("a/FL_foot", "a/FR_foot"));
  EXPECT_TRUE(has("b/FL_foot", "b/FR_foot"));
  EXPECT_TRUE(has("a/FL_foot", "b/FR_foot"));
}

TEST(SrdfApart, CountsInTheHashOfAModel) {
  const QuadrupedPackage package;
  SimulationOptions without;
  without.srdf = "none";
  EXPECT_NE(hash(loadScene(package.urdf)->model), hash(loadScene(package.urdf, without)->model));
}

// What it compares with reads none; a state is asked for by name all the same.
TEST(Srdf, IsNotReadForMujoco) {
  const QuadrupedPackage package;
  SimulationOptions options;
  options.likeMujoco = true;
  EXPECT_TRUE(loadScene(package.urdf, options)->model.apart.empty());
  options.state = "standing";
  EXPECT_EQ(position(*loadScene(package.urdf, options), "FL_hip"), 0.7);
}

TEST(Srdf, StepsOfASimulationAreThoseOfItsState) {
  const QuadrupedPackage package;
  Simulation a = Simulation::load(package.urdf, inState("standing")),
             b = Simulation::load(package.urdf.string(), [&] {
               SimulationOptions options;
               for (const std::string leg : {"FL", "FR", "RL", "RR"}) {
                 options.q0.emplace_back(leg + "_hip", 0.7);
                 options.q0.emplace_back(leg + "_knee", -1.4);
               }
               return options;
             }());
  a.goals.posture();
  b.goals.posture();
  a.run(0.2);
  b.run(0.2);
  EXPECT_EQ(hash(a.state()), hash(b.state()));
}

// Thighs turn forward by 0.3, knees back by 2.5: calves rise by 0.2 cos(2.2 from straight down)
// behind the knees, whose balls are 1 cm larger than the feet.
TEST(Stance, OnShinsIsReportedAndOnFeetIsNot) {
  const QuadrupedPackage package;
  const auto kneeling = loadScene(package.urdf, inState("kneeling"));
  const double height = -0.2 * std::cos(2.2) + 0.03 - 0.02;
  ASSERT_EQ(kneeling->bases.stances.size(), 1u);
  const std::string& stance = kneeling->bases.stances[0];
  const std::string expected = "trunk stands on FL_calf, FL_foot is " +
                               std::to_string(static_cast<int>(1e3 * height + 0.5)) +
                               " mm in the air, and so are FR_foot, RL_foot, RR_foot; another "
                               "start: --state standing, mixed";
  EXPECT_NE(stance.find(expected), std::string::npos) << stance << "\n" << expected;
  EXPECT_TRUE(warns(*kneeling, "FL_foot"));
  EXPECT_TRUE(loadScene(package.urdf, inState("standing"))->bases.stances.empty());
}

TEST(Stance, OnTheTrunkIsReportedByTheNameOfFeet) {
  const QuadrupedPackage package;
  SimulationOptions options;
  for (const std::string leg : {"FL", "FR", "RL", "RR"}) {
    options.q0.emplace_back(leg + "_hip", 1.9);
    options.q0.emplace_back(leg + "_knee", -0.6);
  }
  const auto lying = loadScene(package.urdf, options);
  ASSERT_EQ(lying->bases.stances.size(), 1u);
  EXPECT_NE(lying->bases.stances[0].find("trunk stands on trunk, FL_foot is"), std::string::npos)
      << lying->bases.stances[0];
}

TEST(Stance, OfTheRobotsOfTheTreeIsAsTheyAreMeant) {
  for (const char* name : {"humanoid", "arm", "hand", "picker"})
    EXPECT_TRUE(loadScene(robot(name))->bases.stances.empty()) << name;
}

TEST(Stance, StraightKneesAreKnownFromBentOnes) {
  const QuadrupedPackage package;
  const std::string straight = loadScene(package.urdf)->bases.straightKnees;
  EXPECT_NE(straight.find("FL_knee, FR_knee, RL_knee, RR_knee"), std::string::npos) << straight;
  EXPECT_NE(straight.find("--state standing, kneeling, mixed"), std::string::npos) << straight;
  EXPECT_EQ(loadScene(package.urdf, inState("standing"))->bases.straightKnees, "");
  // 6° is the bound, of the point of contact, which is below the middle of the foot.
  SimulationOptions options;
  options.srdf = "none";
  for (const auto& [bend, told] : {std::pair{0.08, true}, std::pair{0.15, false}}) {
    options.q0.clear();
    for (const std::string leg : {"FL", "FR", "RL", "RR"})
      options.q0.emplace_back(leg + "_knee", -bend);
    const std::string knees = loadScene(package.urdf, options)->bases.straightKnees;
    EXPECT_EQ(knees.find("FL_knee") != std::string::npos, told) << bend << ": " << knees;
  }
  const std::string humanoid = loadScene(robot("humanoid"))->bases.straightKnees;
  EXPECT_NE(humanoid.find("left_knee"), std::string::npos) << humanoid;
  EXPECT_NE(humanoid.find("right_knee"), std::string::npos) << humanoid;
  EXPECT_NE(humanoid.find("--q0"), std::string::npos) << humanoid;
}

}  // namespace
}  // namespace softgauss::test

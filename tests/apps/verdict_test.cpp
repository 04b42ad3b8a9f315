// SPDX-License-Identifier: Apache-2.0
/// What a person reads at the end of a run: did it stand, what was reached, what was not and why.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

using Json = nlohmann::json;

/// A run with its summary.
struct Told {
  explicit Told(std::vector<std::string> arguments) {
    const std::string summary = folder.path() / "summary.json";
    arguments.insert(arguments.end(), {"--summary", summary});
    outcome = simulate(arguments);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    if (outcome.exitCode == 0) json = Json::parse(readFile(summary));
  }
  /// The verdict's first line of that word, or nothing.
  std::string line(const std::string& word) const {
    for (const Json& said : json["verdict"])
      if (const std::string text = said; text.starts_with(word + ": ")) return text;
    return {};
  }
  bool says(const std::string& word, const std::string& part) const {
    return line(word).find(part) != std::string::npos;
  }
  Json goal(const std::string& name) const {
    for (const Json& goal : json["goals"])
      if (goal["name"] == name) return goal;
    return {};
  }

  io::TempFolder folder;
  Outcome outcome;
  Json json;
};

/// One arm of two strong joints, 0.3 m and 0.3 m, and a weak one beside it that holds a weight up.
const char* const kTwoArms = R"(<robot name="two_arms"><link name="world"/>
  <link name="upper"><inertial><origin xyz="0.15 0 0"/><mass value="1"/>
    <inertia ixx="0.001" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="fore"><inertial><origin xyz="0.15 0 0"/><mass value="1"/>
    <inertia ixx="0.001" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="hand"/>
  <link name="weight"><inertial><origin xyz="0.3 0 0"/><mass value="5"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="revolute"><parent link="world"/><child link="upper"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="100" velocity="10"/>
    <dynamics damping="0.5"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="fore"/>
    <origin xyz="0.3 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2.5" upper="2.5" effort="50" velocity="10"/><dynamics damping="0.5"/></joint>
  <joint name="wrist" type="fixed"><parent link="fore"/><child link="hand"/>
    <origin xyz="0.3 0 0"/></joint>
  <joint name="weak" type="revolute"><parent link="world"/><child link="weight"/>
    <origin xyz="0 1 0"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="2" velocity="10"/><dynamics damping="0.5"/></joint>
</robot>)";

/// A plate with a heavy arm that stretches out over its edge.
std::string plateWithArm(const std::string& root) {
  return R"(<robot name="plate"><link name=")" + root + R"("><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.2 0.2 0.02"/></geometry></collision></link>
  <link name="arm"><inertial><origin xyz="0.4 0 0"/><mass value="4"/>
    <inertia ixx="0.01" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.05 0.05"/></geometry></collision>
  </link>
  <joint name="hinge" type="revolute"><parent link=")" +
         root + R"("/><child link="arm"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="100" velocity="5"/><dynamics damping="5"/></joint></robot>)";
}

TEST(Verdict, AHumanoidThatLiesOnTheGroundFell) {
  const Told run({dataFile("robots/humanoid.urdf"), "--passive", "--duration", "2"});
  EXPECT_EQ(run.json["outcome"], "fell");
  EXPECT_TRUE(run.says("fell", "base pelvis: came down by")) << run.json["verdict"];
  EXPECT_TRUE(std::regex_search(run.line("fell"), std::regex("on the ground since [0-9.]+ s: ")));
  EXPECT_EQ(run.outcome.out.find("completed"), std::string::npos) << run.outcome.out;
}

// Pushed twice as hard as in the scene it ends bent over, 0.77 m lower, on nothing but its feet.
TEST(Verdict, AHumanoidThatIsFoldedOverItsFeetFell) {
  const io::TempFolder folder;
  std::string scene = readFile(dataFile("scenes/humanoid_pushed.yaml"));
  const auto replaceAll = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = scene.find(from, at)) != std::string::npos; at += to.size())
      scene.replace(at, from.size(), to);
  };
  replaceAll("60", "120");
  replaceAll("../", dataFile("scenes/../"));
  const Told run({folder.write("pushed.yaml", scene), "--duration", "4"});
  EXPECT_EQ(run.json["outcome"], "fell") << run.json["verdict"];
  EXPECT_FALSE(run.says("stood", "base pelvis")) << run.json["verdict"];
}

TEST(Verdict, APlaceForABaseThatFloatsIsAJobOfAllJoints) {
  const Told run(
      {dataFile("robots/humanoid.urdf"), "--reach", "pelvis=0,0,2", "--duration", "0.1"});
  EXPECT_TRUE(run.says("not reached", "reach pelvis")) << run.json["verdict"];
  EXPECT_EQ(run.line("not reached").find("actuated"), std::string::npos) << run.json["verdict"];
}

TEST(Verdict, SharesOfStepsAreWholePercents) {
  const Told run({dataFile("scenes/weak_arm.yaml"), "--duration", "1"});
  EXPECT_TRUE(std::regex_search(run.line("saturated"), std::regex(" in [0-9]+ % of the steps")))
      << run.json["verdict"];
}

// Nothing holds it: its feet are on the ground, and the pelvis on its way.
TEST(Verdict, AHumanoidOnItsWayDownIsFalling) {
  const Told run({dataFile("robots/humanoid.urdf"), "--passive", "--duration", "1.2"});
  EXPECT_NE(run.line("falling"), "") << run.json["verdict"];
  EXPECT_EQ(run.line("stood"), "");
}

// Its pelvis is down before 3 s, and no bounce of a limb after that makes it later.
TEST(Verdict, ARobotFellWhenItsFirstLinkCameDown) {
  const auto since = [](const char* duration) {
    const Told run({dataFile("robots/humanoid.urdf"), "--passive", "--duration", duration});
    std::smatch found;
    const std::string line = run.line("fell");
    EXPECT_TRUE(std::regex_search(line, found, std::regex("since ([0-9.]+) s"))) << line;
    return found.size() > 1 ? std::stod(found[1]) : 0.0;
  };
  EXPECT_EQ(since("3"), since("6"));
}

TEST(Verdict, AHumanoidThatHoldsItsPostureStood) {
  const Told run({dataFile("robots/humanoid.urdf"), "--posture", "--duration", "1"});
  EXPECT_EQ(run.json["outcome"], "completed");
  EXPECT_TRUE(run.says("stood", "base pelvis: ")) << run.json["verdict"];
  EXPECT_TRUE(run.says("reached", "posture")) << run.json["verdict"];
  EXPECT_EQ(run.goal("posture")["unit"], "rad");
}

TEST(Verdict, WithoutGroundItIsInTheAir) {
  const Told run(
      {dataFile("robots/humanoid.urdf"), "--passive", "--ground", "none", "--duration", "2"});
  EXPECT_TRUE(run.says("in the air", "falls at 19.6 m/s")) << run.json["verdict"];
}

// 1.68 m from the shoulder, for an arm of 0.96 m: 0.72 m are left
// (data/goals/arm_out_of_reach.yaml).
TEST(Verdict, APlaceOutOfReachIsToldByHowMuch) {
  const Told run({dataFile("robots/arm.urdf"), "--goals", dataFile("goals/arm_out_of_reach.yaml"),
                  "--duration", "6"});
  EXPECT_TRUE(run.says("not reached", "out of reach of the chain by 72")) << run.json["verdict"];
  EXPECT_EQ(run.goal("reach hand")["reached"], false);
}

TEST(Verdict, APlaceThatRangesForbidIsToldApart) {
  const io::TempFolder folder;
  const std::string robot = folder.write("arms.urdf", kTwoArms);
  // 0.1 m from the shoulder: the elbow would have to bend by 2.8 rad, of 2.5. It comes as near as
  // √(0.18 (1 + cos 2.5)) = 0.189 m.
  const Told run({robot, "--reach", "hand=-0.1,0,0", "--duration", "4"});
  EXPECT_TRUE(run.says("not reached", "the ranges of its joints keep it 89.2 mm away"))
      << run.json["verdict"];
}

// A joint at its limit on another arm is no reason; one between base and link is.
TEST(Verdict, BlamesTheJointsBetweenBaseAndLink) {
  const io::TempFolder folder;
  const std::string robot = folder.write("arms.urdf", kTwoArms);
  const std::string goals = folder.write("goals.yaml", R"(goals:
  - reach: {link: hand, target: [0, 0, 2]}
  - joint_posture: {joints: {weak: 0.0}}
)");
  const Told run({robot, "--goals", goals, "--duration", "3"});
  EXPECT_TRUE(run.says("saturated", "weak")) << run.json["verdict"];
  const std::string hand = run.goal("reach hand")["reason"];
  EXPECT_EQ(hand.find("torque limit"), std::string::npos) << hand;
  EXPECT_NE(hand.find("out of reach of the chain by 1.4 m"), std::string::npos) << hand;
  const std::string weak = run.goal("joint_posture")["reason"];
  EXPECT_NE(weak.find("torque limit of weak"), std::string::npos) << weak;
}

/// A trunk of 30 cm on four legs that give way by 10 cm, whose feet begin so far below it [m].
std::string stool(double below) {
  std::string urdf = R"(<robot name="stool"><link name="trunk"><inertial><mass value="8"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.4 0.4 0.3"/></geometry></collision></link>)";
  for (const char* place : {"0.15 0.15", "0.15 -0.15", "-0.15 0.15", "-0.15 -0.15"})
    urdf += fmt::format(R"(<link name="leg {0}"><inertial><mass value="0.2"/>
    <inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><box size="0.05 0.05 0.04"/></geometry></collision></link>
  <joint name="slide {0}" type="prismatic"><parent link="trunk"/><child link="leg {0}"/>
    <origin xyz="{0} {1}"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.1" effort="100" velocity="1"/><dynamics damping="400"/></joint>)",
                        place, -0.13 - below);
  return urdf + "</robot>";
}

// No quarter of its height, and it lies on itself. What was 2 mm above the ground does not.
TEST(Verdict, ARobotThatLiesOnItsTrunkFell) {
  const io::TempFolder folder;
  const auto told = [&](double below) {
    return Told({folder.write("s.urdf", stool(below)), "--passive", "--duration", "3"});
  };
  EXPECT_TRUE(std::regex_search(told(0.03).line("fell"), std::regex("on the ground since.*trunk")));
  EXPECT_TRUE(told(0.002).says("stood", "base trunk"));
}

// The base of a plate is no chain that could be too short, wherever it is sent.
TEST(Verdict, ABaseIsNotOutOfReachOfAChain) {
  const io::TempFolder folder;
  const Told run({folder.write("plate.urdf", plateWithArm("plate")), "--reach", "plate=0.5,0,0.01",
                  "--duration", "1"});
  EXPECT_FALSE(run.line("not reached").empty()) << run.json["verdict"];
  EXPECT_FALSE(run.says("not reached", "out of reach")) << run.json["verdict"];
}

// The ball keeps the fingers open, and a ball that falls is no posture that is off.
TEST(Verdict, WhatAJointPressesAgainstIsAReasonAndObjectsAreNoPosture) {
  const Told run({dataFile("scenes/hand_and_ball.yaml"), "--duration", "1"});
  EXPECT_TRUE(std::regex_search(run.line("off"), std::regex("contact of hand/[a-z_]+ with ball")))
      << run.json["verdict"];
  EXPECT_TRUE(run.goal("posture (base)").is_null()) << run.json["goals"];
}

TEST(Verdict, AJointCalled3IsNoNumber) {
  const io::TempFolder folder;
  const std::string urdf =
      std::regex_replace(kTwoArms, std::regex("joint name=\"weak\""), "joint name=\"3\"");
  const std::string goals =
      folder.write("goals.yaml", "goals: [joint_posture: {joints: {'3': 0.0}}]\n");
  const Told run({folder.write("arms.urdf", urdf), "--goals", goals, "--duration", "2"});
  EXPECT_TRUE(run.says("not kept", "farthest is '3'")) << run.json["verdict"];
  EXPECT_TRUE(run.says("saturated", "'3' in ")) << run.json["verdict"];
}

// 5 kg at 0.3 m are 14.7 N m; the joint has 2. The other arm carries 8.8 of 100 and 1.5 of 50.
TEST(Verdict, JointsThatCannotHoldTheStartAreToldWithBothFigures) {
  const io::TempFolder folder;
  const Told run(
      {folder.write("arms.urdf", kTwoArms), "--reach", "hand=0,0,-0.5", "--duration", "0.01"});
  const std::string warnings = run.json["warnings"].dump();
  EXPECT_NE(warnings.find("cannot hold the start against gravity: weak needs 14.7 of 2 N m;"),
            std::string::npos)
      << warnings;
  const Told strong({dataFile("robots/humanoid.urdf"), "--posture", "--duration", "0.01"});
  EXPECT_EQ(strong.json["warnings"].dump().find("cannot hold"), std::string::npos);
}

TEST(Verdict, AngleOfAPostureThatFitsInDegreesIsToldAtTheStart) {
  const io::TempFolder folder;
  const std::string robot = folder.write("arms.urdf", kTwoArms);
  const auto warnings = [&](const std::string& goals) {
    const Told run({robot, "--goals", folder.write("goals.yaml", "goals: [" + goals + "]\n"),
                    "--duration", "0.01"});
    return run.json["warnings"].dump();
  };
  const char* const told =
      " sends elbow to 90, beyond its range -2.5 .. 2.5 (1.5708 rad if it is in degrees)";
  for (const std::string kind : {"joint_posture", "posture"}) {
    EXPECT_NE(warnings(kind + ": {joints: {elbow: 90}}").find(kind + told), std::string::npos)
        << warnings(kind + ": {joints: {elbow: 90}}");
    EXPECT_EQ(warnings(kind + ": {joints: {elbow: 2.6}}").find("degrees"), std::string::npos);
  }
}

// Nothing stands or falls: what was reached is the first line, and the heading of the page.
TEST(Verdict, OfAFixedRobotBeginsWithItsGoals) {
  const Told run({dataFile("robots/arm.urdf"), "--reach", "hand=0.5,0.3,0.5", "--duration", "2"});
  EXPECT_EQ(run.json["verdict"][0].get<std::string>().substr(0, 8), "reached:");
  const Told passive({dataFile("robots/arm.urdf"), "--passive", "--duration", "0.1"});
  EXPECT_EQ(passive.json["verdict"][0].get<std::string>().substr(0, 10), "completed:");
}

// The first place is judged when its goal ends, wherever the hand is later.
TEST(Verdict, EveryGoalIsJudgedAtItsOwnEnd) {
  const io::TempFolder folder;
  const std::string goals = folder.write("goals.yaml", R"(goals:
  - reach: {link: hand, target: [0.5, 0.3, 0.5], end: 2.0}
  - reach: {link: hand, target: [0.5, -0.2, 0.6], start: 2.0}
  - reach: {link: hand, target: [0, 0, 0], start: 9.0}
  - damping: {}
)");
  const Told run({dataFile("robots/arm.urdf"), "--goals", goals, "--duration", "4"});
  ASSERT_EQ(run.json["goals"].size(), 3u);
  const Json &first = run.json["goals"][0], &second = run.json["goals"][1];
  EXPECT_EQ(first["reached"], true) << first;
  EXPECT_NEAR(first["judged_at_s"].get<double>(), 1.998, 1e-9);
  EXPECT_LT(first["final_error_m"].get<double>(), 0.01);
  EXPECT_NEAR(second["judged_at_s"].get<double>(), 4.0, 1e-9);
  EXPECT_EQ(second["reached"], true) << second;
  EXPECT_NE(run.json["goals"][2]["reason"].get<std::string>().find("begins at 9 s"),
            std::string::npos);
}

TEST(Verdict, GoalsThatAreNoPlacesHaveTheirOwnFigures) {
  const io::TempFolder folder;
  const std::string goals = folder.write("goals.yaml", R"(goals:
  - reach: {link: hand, target: [0.5, 0, 0.052], rpy: [3.14159, 0, 0]}
  - contact_force: {link: hand, force: [0, 0, 20], axes: z, weight: 10, start: 1.0}
  - damping: {weight: 1}
)");
  const Told run(
      {dataFile("robots/arm.urdf"), "--ground", "0", "--goals", goals, "--duration", "3"});
  const Json force = run.goal("contact_force hand"), turn = run.goal("reach hand (orientation)");
  EXPECT_EQ(force["unit"], "N");
  EXPECT_LT(force["final_error"].get<double>(), 1.0) << force;
  EXPECT_EQ(turn["unit"], "rad");
  EXPECT_LT(turn["final_error"].get<double>(), 0.05) << turn;
}

/// A reach of the two arms within a second, the joints at most so fast [rad/s].
Told reachAtSpeed(const char* speed, const std::vector<std::string>& more = {}) {
  const io::TempFolder folder;
  const std::string urdf = std::regex_replace(kTwoArms, std::regex("velocity=\"10\""),
                                              fmt::format("velocity=\"{}\"", speed));
  std::vector<std::string> arguments = {folder.write("arms.urdf", urdf), "--reach", "hand=0,0,-0.5",
                                        "--duration", "1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Told(arguments);
}

// At 0.2 rad/s the shoulder turns by 0.2 rad of the 1.6 that the reach takes.
TEST(Verdict, NamesTheJointsWhoseVelocityLimitsKeepAGoalOff) {
  const Told slow = reachAtSpeed("0.2");
  EXPECT_TRUE(slow.says("not reached", "velocity limit of shoulder")) << slow.json["verdict"];
  EXPECT_TRUE(slow.line("too fast").find("shoulder") == std::string::npos) << slow.line("too fast");
  const Told fast = reachAtSpeed("10");
  EXPECT_FALSE(fast.says("not reached", "velocity limit")) << fast.json["verdict"];
}

TEST(Verdict, NamesTheJointsThatAreTooFast) {
  const Told run = reachAtSpeed("0.2", {"--ignore-velocity-limits"});
  EXPECT_TRUE(
      std::regex_search(run.line("too fast"), std::regex("shoulder at [0-9.]+ rad/s, limit 0.2")))
      << run.json["verdict"];
}

TEST(Base, TheConventionIsALineOfEveryRun) {
  const auto out = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--passive", "--duration", "0.01"});
    return simulate(arguments).out;
  };
  const std::string humanoid = dataFile("robots/humanoid.urdf");
  EXPECT_TRUE(out({humanoid}).starts_with("base pelvis floats; --base fixed bolts it down\n"));
  EXPECT_TRUE(out({humanoid, "--base", "fixed"})
                  .starts_with("base pelvis is bolted down; --base floating lets it go\n"));
}

TEST(Base, ABodyAloneFloats) {
  const io::TempFolder folder;
  const std::string stone = folder.write("stone.urdf", R"(<robot name="stone"><link name="stone">
    <inertial><mass value="1"/>
      <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.1"/></geometry></collision></link></robot>)");
  const Told run({stone, "--passive", "--duration", "0.01"});
  EXPECT_EQ(run.json["bases"][0], "base stone floats; --base fixed bolts it down");
}

TEST(Base, AGuessIsToldWithItsReason) {
  const io::TempFolder folder;
  const std::string plate = folder.write("plate.urdf", plateWithArm("plate"));
  const Told arm({plate, "--base", "auto", "--passive", "--duration", "0.01"});
  EXPECT_EQ(arm.json["bases"][0],
            "base plate is bolted down, a guess, for nothing but its root would touch the ground; "
            "--base floating lets it go");
  EXPECT_EQ(arm.json["model"]["dof"], 1);
  const Told humanoid(
      {dataFile("robots/humanoid.urdf"), "--base", "auto", "--passive", "--duration", "0.01"});
  EXPECT_EQ(humanoid.json["model"]["dof"], 27);
  EXPECT_NE(humanoid.json["bases"][0].get<std::string>().find("a guess, for it stands on"),
            std::string::npos);
}

// Of 5 kg, 4 are 0.4 m out: the centre of mass is 0.32 m from the middle of a plate of ±0.1 m.
TEST(Base, ACentreOfMassOutsideTheSupportIsToldBeforeTheStartAndAtTheEnd) {
  const io::TempFolder folder;
  const std::string plate = folder.write("plate.urdf", plateWithArm("plate"));
  const Told run({plate, "--passive", "--duration", "2"});
  EXPECT_NE(run.outcome.err.find("centre of mass is 220 mm outside its support"), std::string::npos)
      << run.outcome.err;
  EXPECT_TRUE(run.says("base", "--base fixed bolts it down")) << run.json["verdict"];
  EXPECT_EQ(run.json["outcome"], "fell");
  const Told bolted({plate, "--base", "fixed", "--passive", "--duration", "0.1"});
  EXPECT_EQ(bolted.outcome.err, "");
}

TEST(Table, SolverIsForDetails) {
  std::vector<std::string> arguments = {dataFile("robots/arm.urdf"), "--reach", "hand=0.5,0.3,0.5",
                                        "--duration", "0.02"};
  EXPECT_EQ(simulate(arguments).out.find("constraint rows"), std::string::npos);
  arguments.push_back("--details");
  EXPECT_NE(simulate(arguments).out.find("constraint rows"), std::string::npos);
}

}  // namespace
}  // namespace softgauss::test

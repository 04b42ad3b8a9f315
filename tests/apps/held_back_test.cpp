// SPDX-License-Identifier: Apache-2.0
/// Goals that cannot be reached for a reason that is known: the verdict names it with the largest
/// share. A test per reason.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

using Json = nlohmann::json;

/// A planar arm of two links of 0.3 m in the plane y = 0, on a post, with balls to touch with: at
/// q = 0 it points along x, 0.5 m above the ground, and carries 8.8 N m at the shoulder, 1.5 at the
/// elbow.
struct PostArm {
  double shoulderEffort = 100.0, elbowEffort = 50.0, speed = 10.0, shoulderEnd = 3.0,
         elbowEnd = 2.5, elbow = 0.0;  // the latter at the start

  std::string urdf() const {
    const auto link = [](const char* name) {
      return fmt::format(R"(<link name="{}"><inertial><origin xyz="0.15 0 0"/><mass value="1"/>
    <inertia ixx="0.001" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>)",
                         name);
    };
    const auto hinge = [&](const char* name, const char* parent, const char* child,
                           const char* place, double end, double effort) {
      return fmt::format(R"(<joint name="{}" type="revolute"><parent link="{}"/><child link="{}"/>
    <origin xyz="{}"/><axis xyz="0 1 0"/>
    <limit lower="-{}" upper="{}" effort="{}" velocity="{}"/><dynamics damping="0.5"/></joint>)",
                         name, parent, child, place, end, end, effort, speed);
    };
    return R"(<robot name="arm"><link name="world"/><link name="post"><collision>
    <origin xyz="0 0 0.25"/><geometry><box size="0.1 0.1 0.3"/></geometry></collision></link>
  <joint name="foot" type="fixed"><parent link="world"/><child link="post"/></joint>)" +
           link("upper") + link("fore") +
           R"(<link name="hand"><inertial><mass value="0.01"/>
    <inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.03"/></geometry></collision></link>)" +
           hinge("shoulder", "world", "upper", "0 0 0.5", shoulderEnd, shoulderEffort) +
           hinge("elbow", "upper", "fore", "0.3 0 0", elbowEnd, elbowEffort) +
           R"(<joint name="wrist" type="fixed"><parent link="fore"/><child link="hand"/>
    <origin xyz="0.3 0 0"/></joint></robot>)";
  }
};

/// A goal of a run of the arm, and the run's verdict.
struct GoalOfRun {
  Json goal, verdict;
};

/// `more`: of the scene, such as objects.
GoalOfRun goalOf(const PostArm& arm, const std::string& goals, const std::string& name,
                 const std::string& more, const char* duration) {
  const io::TempFolder folder;
  folder.write("arm.urdf", arm.urdf());
  const std::string scene = folder.write(
      "scene.yaml", "robots: [{urdf: arm.urdf, joints: {elbow: " + fmt::format("{}", arm.elbow) +
                        "}}]\n" + more + "\ngoals:\n" + goals);
  const std::string summary = folder.path() / "summary.json";
  const Outcome outcome = simulate({scene, "--duration", duration, "--summary", summary});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  if (outcome.exitCode != 0) return {};
  const Json json = Json::parse(readFile(summary));
  for (const Json& one : json["goals"])
    if (one["name"] == name) return {one, json["verdict"]};
  ADD_FAILURE() << "no " << name;
  return {};
}

/// A run of the arm and what became of a goal of it that is not reached.
struct HeldRun {
  Json goal, verdict;

  HeldRun(const PostArm& arm, const std::string& goals, const std::string& name,
          const std::string& more = {}, const char* duration = "3") {
    GoalOfRun run = goalOf(arm, goals, name, more, duration);
    verdict = run.verdict;
    if (run.goal.is_null()) return;
    EXPECT_FALSE(run.goal["reached"]) << name << " was reached: " << verdict;
    if (run.goal["reached"]) return;
    goal = run.goal;
    double sum = 0.0, last = 1.0;
    for (const Json& cause : goal["held_back_by"]) {
      sum += cause["share"].get<double>();
      EXPECT_LE(cause["share"].get<double>(), last);
      last = cause["share"];
    }
    if (goal["held_back_by"].empty()) return;
    EXPECT_NEAR(sum, 1.0, 1e-6) << goal;
  }
  std::string cause() const {
    return goal.is_null() || goal["held_back_by"].empty()
               ? ""
               : goal["held_back_by"][0]["what"].get<std::string>();
  }
  double share() const { return goal["held_back_by"][0]["share"]; }
  std::string reason() const { return goal.is_null() ? "" : goal["reason"].get<std::string>(); }
};

const char* const kDown = "  - reach: {link: hand, target: [0.3, 0, 0.2]}\n";
const char* const kDamping = "  - damping: {weight: 1}\n";

// ---- Weights -----------------------------------------------------------------------------------

TEST(HeldBack, ByAPostureThatWeighsMore) {
  const HeldRun run({},
                    "  - reach: {link: hand, target: [0.3, 0, 0.2], weight: 10}\n"
                    "  - posture: {weight: 1000}\n",
                    "reach hand");
  EXPECT_EQ(run.cause(), "posture") << run.goal;
  EXPECT_TRUE(std::regex_search(run.reason(), std::regex("held back by posture (99|100) %")))
      << run.goal;
}

// The trial goes on from where the posture holds the hand, a run with that weight from the start:
// they end in the same place but for what both still move, a fifth of a millimetre.
TEST(HeldBack, AnotherWeightLeavesWhatIsSaid) {
  const char* const goals =
      "  - reach: {{link: hand, target: [0.3, 0, 0.2], weight: {}}}\n  - posture: {{weight: "
      "1000}}\n";
  const Json held = goalOf({}, fmt::format(fmt::runtime(goals), 10), "reach hand", "", "3").goal;
  ASSERT_TRUE(held.contains("with_weight")) << held;
  const double weight = held["with_weight"]["weight"], left = held["with_weight"]["error_m"];
  EXPECT_LT(left, 0.01);
  EXPECT_NE(held["reason"].get<std::string>().find("; a weight of 1e"), std::string::npos);
  const Json again =
      goalOf({}, fmt::format(fmt::runtime(goals), weight), "reach hand", "", "3").goal;
  EXPECT_TRUE(again["reached"]) << again;
  EXPECT_NEAR(again["final_error_m"].get<double>(), left, 2e-4);
}

TEST(HeldBack, NoWeightIsNamedWhereNoneHelps) {
  for (const char* target : {"[0, 0, 2]", "[0.3, 0, 0.5]"}) {
    const Json goal =
        goalOf({}, std::string("  - reach: {link: hand, target: ") + target + "}\n" + kDamping,
               "reach hand", "", "4")
            .goal;
    EXPECT_FALSE(goal.contains("with_weight")) << goal;
    EXPECT_EQ(goal["reason"].get<std::string>().find("a weight of"), std::string::npos);
  }
}

TEST(HeldBack, ByAHoldThatWeighsMore) {
  const HeldRun run({},
                    "  - reach: {link: hand, target: [0.3, 0, 0.2], weight: 10}\n"
                    "  - hold: {link: fore, weight: 1e4}\n",
                    "reach hand");
  EXPECT_EQ(run.cause(), "hold fore") << run.goal;
}

TEST(HeldBack, OfAPostureByAReach) {
  const HeldRun run({},
                    "  - reach: {link: hand, target: [0.3, 0, 0.2], weight: 1e5}\n"
                    "  - joint_posture: {joints: {elbow: 0}, weight: 10}\n",
                    "joint_posture");
  EXPECT_EQ(run.cause(), "reach hand") << run.goal;
}

// ---- The price of force ------------------------------------------------------------------------

TEST(HeldBack, ByThePriceOfForceWhereAPlaceIsWorthLittle) {
  const HeldRun run({}, "  - reach: {link: hand, target: [0.3, 0, 0.2], weight: 0.01}\n",
                    "reach hand", "", "1");
  EXPECT_EQ(run.cause(), "control cost") << run.goal;
}

TEST(HeldBack, ByThePriceOfAllForceWhereThatCounts) {
  const HeldRun run({}, "  - reach: {link: hand, target: [0.5, 0, 0.6], weight: 5}\n", "reach hand",
                    "control_cost: total", "6");
  EXPECT_EQ(run.cause(), "control cost") << run.goal;
}

// ---- Torque ------------------------------------------------------------------------------------

TEST(HeldBack, ByATorqueThatIsTooSmallForTheWeight) {
  PostArm arm;
  arm.shoulderEffort = 4.0;
  const HeldRun run(arm,
                    std::string("  - reach: {link: hand, target: [0.55, 0, 0.55]}\n") + kDamping,
                    "reach hand", "", "6");
  EXPECT_EQ(run.cause(), "torque limit of shoulder") << run.goal;
}

TEST(HeldBack, OfAJointByItsTorque) {
  PostArm arm;
  arm.elbowEffort = 0.5;
  const HeldRun run(
      arm, std::string("  - joint_posture: {joints: {shoulder: 0, elbow: 0}}\n") + kDamping,
      "joint_posture", "", "6");
  EXPECT_EQ(run.cause(), "torque limit of elbow") << run.goal;
}

TEST(HeldBack, ByTheLimitOfAMotor) {
  const HeldRun run({},
                    "  - joint_posture: {joints: {shoulder: 0}}\n"
                    "  - joint_posture: {joints: {elbow: 0}, weight: 1e6}\n  - damping: {}\n",
                    "joint_posture", "actuators: [{name: motor, joints: {shoulder: 2}, effort: 2}]",
                    "6");
  EXPECT_EQ(run.cause(), "limit of motor") << run.goal;
}

// ---- Ranges ------------------------------------------------------------------------------------

// 0.1 m from the shoulder, where the elbow would have to bend by 2.8 rad, of 2.5.
TEST(HeldBack, ByRangesThatKeepEveryConfigurationAway) {
  PostArm arm;
  arm.elbow = 1.0;
  const HeldRun run(arm,
                    std::string("  - reach: {link: hand, target: [-0.1, 0, 0.5]}\n") + kDamping,
                    "reach hand", "", "4");
  EXPECT_EQ(run.cause(), "range of elbow") << run.goal;
  EXPECT_NE(run.reason().find("the ranges of its joints keep it 89.2 mm away"), std::string::npos);
}

TEST(HeldBack, ByTheRangeOfTheJointThatIsAtItsEnd) {
  PostArm arm;
  arm.elbowEnd = 1.0;
  const HeldRun run(arm, std::string("  - joint_posture: {joints: {elbow: 1.2}}\n") + kDamping,
                    "joint_posture");
  EXPECT_EQ(run.cause(), "range of elbow") << run.goal;
}

TEST(HeldBack, OfATurnedLinkByTheRangeOfItsJoint) {
  PostArm arm;
  arm.elbowEnd = 0.4;
  const HeldRun run(arm,
                    "  - reach: {link: fore, target: [0.3, 0, 0.5], rpy: [0, 1, 0], weight: 1000}\n"
                    "  - damping: {}\n",
                    "reach fore (orientation)");
  EXPECT_EQ(run.cause(), "range of elbow") << run.goal;
}

// ---- Reach -------------------------------------------------------------------------------------

TEST(HeldBack, ByAChainThatIsTooShort) {
  const HeldRun run({}, std::string("  - reach: {link: hand, target: [0, 0, 2]}\n") + kDamping,
                    "reach hand", "", "4");
  EXPECT_EQ(run.cause(), "reach of the chain") << run.goal;
  EXPECT_NE(run.reason().find("out of reach of the chain by 900 mm"), std::string::npos)
      << run.goal;
}

TEST(HeldBack, ByAChainThatIsTooShortMoreThanByAPosture) {
  const HeldRun run({},
                    "  - reach: {link: hand, target: [0, 0, 2], weight: 300}\n"
                    "  - posture: {weight: 1000}\n",
                    "reach hand", "", "4");
  EXPECT_EQ(run.cause(), "reach of the chain") << run.goal;
  EXPECT_TRUE(std::regex_search(run.reason(),
                                std::regex("out of reach of the chain by 900 mm; held back by "
                                           "reach of the chain [0-9]+ %, posture [0-9]+ %")))
      << run.goal;
}

// Stretched towards the place and away from it no joint moves the hand along its arm.
TEST(HeldBack, ByAConfigurationInWhichNoJointMovesItThere) {
  const HeldRun run({}, std::string("  - reach: {link: hand, target: [0.3, 0, 0.5]}\n") + kDamping,
                    "reach hand");
  EXPECT_EQ(run.cause(), "singular configuration") << run.goal;
  EXPECT_EQ(run.reason(), "no joint brings it nearer from there");
}

// ---- Contacts ----------------------------------------------------------------------------------

TEST(HeldBack, ByAWallInTheWay) {
  const HeldRun run(
      {},
      std::string("  - reach: {link: hand, target: [0.5, 0, 0.4]}\n"
                  "  - joint_posture: {joints: {elbow: 0}, weight: 0.001}\n") +
          kDamping,
      "reach hand",
      "objects: [{name: wall, box: {size: [0.1, 1, 0.4]}, fixed: true, position: [0.5, "
      "0, 0.25]}]");
  EXPECT_EQ(run.cause(), "contact of hand with wall") << run.goal;
}

TEST(HeldBack, ByTheGroundUnderTheHand) {
  const HeldRun run({},
                    std::string("  - reach: {link: hand, target: [0.3, 0, -0.05]}\n") + kDamping,
                    "reach hand", "ground: 0");
  EXPECT_EQ(run.cause(), "contact of hand with ground") << run.goal;
}

TEST(HeldBack, OfAJointByWhatItsLinkPressesAgainst) {
  const HeldRun run(
      {}, std::string("  - joint_posture: {joints: {shoulder: 0.9, elbow: 0}}\n") + kDamping,
      "joint_posture",
      "objects: [{name: wall, box: {size: [0.1, 1, 0.4]}, fixed: true, position: [0.5, "
      "0, 0.15]}]");
  EXPECT_EQ(run.cause(), "contact of hand with wall") << run.goal;
}

// ---- Contacts with itself ----------------------------------------------------------------------

TEST(HeldBack, ByThePostThatTheArmStandsOn) {
  const HeldRun run({},
                    std::string("  - reach: {link: hand, target: [-0.02, 0, 0.25]}\n") + kDamping,
                    "reach hand");
  EXPECT_EQ(run.cause(), "contact of hand with post") << run.goal;
}

// ---- Velocity ----------------------------------------------------------------------------------

TEST(HeldBack, ByAJointThatMayNotGoFaster) {
  PostArm arm;
  arm.speed = 0.1;
  const HeldRun run(arm, kDown, "reach hand", "", "1");
  EXPECT_TRUE(run.cause().starts_with("velocity limit of ")) << run.goal;
  EXPECT_NE(run.reason().find("still on its way when the time was up"), std::string::npos);
}

TEST(HeldBack, OfAJointByItsOwnSpeed) {
  PostArm arm;
  arm.speed = 0.1;
  const HeldRun run(arm, "  - joint_posture: {joints: {elbow: 1}}\n", "joint_posture", "", "1");
  EXPECT_EQ(run.cause(), "velocity limit of elbow") << run.goal;
}

// ---- Two goals ---------------------------------------------------------------------------------

TEST(HeldBack, ByAnotherPlaceForTheSameArm) {
  const HeldRun run({},
                    std::string("  - reach: {link: hand, target: [0.3, 0, 0.2], weight: 100}\n"
                                "  - reach: {link: fore, target: [0, 0, 0.8], weight: 100}\n") +
                        kDamping,
                    "reach hand");
  EXPECT_EQ(run.cause(), "reach fore") << run.goal;
}

TEST(HeldBack, OfAPlaceByItsOwnOrientation) {
  PostArm arm;
  arm.elbow = 0.3;
  const HeldRun run(arm,
                    std::string("  - reach: {link: hand, target: [0.4, 0, 0.3], rpy: [0, 0, 0], "
                                "weight: 10, rotation_weight: 1000}\n") +
                        kDamping,
                    "reach hand");
  EXPECT_EQ(run.cause(), "reach hand (orientation)") << run.goal;
}

// ---- What holds by chance is no cause -----------------------------------------------------------

// The elbow is at its torque limit for another goal's sake, and the hand rests on the ground.
TEST(HeldBack, NotByWhatHoldsByChance) {
  PostArm arm;
  arm.elbowEffort = 1.0;
  const HeldRun run(arm,
                    "  - joint_posture: {joints: {shoulder: 0}, weight: 1e5}\n"
                    "  - reach: {link: fore, target: [0, 0, 0.8], weight: 10}\n"
                    "  - joint_posture: {joints: {elbow: 0}, weight: 10}\n",
                    "reach fore");
  EXPECT_EQ(run.cause(), "joint_posture") << run.goal;
  EXPECT_GT(run.share(), 0.95) << run.goal;
}

// A robot on its way is held back by nothing.
TEST(HeldBack, NotWhereTheTimeWasTooShort) {
  const HeldRun run(
      {}, std::string("  - reach: {link: hand, target: [0.3, 0, 0.2], weight: 1e4}\n") + kDamping,
      "reach hand", "", "0.15");
  EXPECT_EQ(run.cause(), "") << run.goal;
  EXPECT_EQ(run.reason(), "still on its way when the time was up") << run.goal;
}

}  // namespace
}  // namespace softgauss::test

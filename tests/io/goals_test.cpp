// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/goals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sample_goals.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

/// Every kind with every key; lines 1 to 9.
const std::string kSampleGoals = R"(# a comment
goals:
  - reach: {link: arm, target: [0.5, -1, 1.5e-1], point: [0.1, 0, 0],
            weight: 7, stiffness: 8, damping: 9,
            minimum_jerk: {duration: 1.5, start: 0.25}}
  - posture: {weight: 10, stiffness: 11, damping: 12, joints: {shoulder: 0.8}}
  - damping:
      weight: 0.5
      rate: 3
)";

Goals read(const std::string& text) {
  const TempFolder folder;
  return readGoals(folder.write("goals.yaml", text), sampleModel(), sampleState());
}

template <class Kind>
const Kind& as(const Goals& goals, std::size_t i) {
  return dynamic_cast<const Kind&>(*goals.at(i));
}

TEST(Goals, ArriveWithTheirValues) {
  const Goals goals = read(kSampleGoals);
  ASSERT_EQ(goals.size(), 3u);

  const auto& reach = as<gdd::Reach>(goals, 0);
  EXPECT_EQ(reach.name(), "reach arm");
  EXPECT_EQ(reach.frame, sampleModel().findFrame("arm"));
  EXPECT_EQ(reach.p_WTarget, Vector3(0.5, -1.0, 0.15));
  EXPECT_EQ(reach.p_FP, Vector3(0.1, 0.0, 0.0));
  EXPECT_EQ(reach.weight, 7.0);
  EXPECT_EQ(reach.stiffness, 8.0);
  EXPECT_EQ(reach.damping, 9.0);
  ASSERT_TRUE(reach.minimumJerk);
  EXPECT_EQ(reach.minimumJerk->duration, 1.5);
  EXPECT_EQ(reach.minimumJerk->startTime, 0.25);

  const auto& posture = as<gdd::Posture>(goals, 1);
  EXPECT_EQ(posture.weight, 10.0);
  EXPECT_EQ(posture.stiffness, 11.0);
  EXPECT_EQ(posture.damping, 12.0);
  VectorX q = sampleState().q;
  q.tail<1>()[0] = 0.8;
  EXPECT_EQ(posture.q, q);

  const auto& damping = as<gdd::VirtualDamping>(goals, 2);
  EXPECT_EQ(damping.weight, 0.5);
  EXPECT_EQ(damping.rate, 3.0);
}

TEST(Goals, MinimumJerkStartsWhereThePointIs) {
  const Goals goals = read(kSampleGoals);
  const auto& reach = as<gdd::Reach>(goals, 0);
  Data data(sampleModel());
  const State state = sampleState();
  computeKinematics(sampleModel(), state, data.kinematics);
  EXPECT_EQ(reach.minimumJerk->p_start, reach.position({sampleModel(), state, data}));
}

TEST(Goals, HaveTheDefaultsOfTheirClasses) {
  const Goals goals = read(
      "goals: [{reach: {link: arm, target: [1, 2, 3]}}, {posture: {}}, {damping: {}},\n"
      "        {reach: {link: arm, target: [1, 2, 3], minimum_jerk: {}}}]");
  ASSERT_EQ(goals.size(), 4u);

  const gdd::Reach reach(sampleModel(), "arm", Vector3(1.0, 2.0, 3.0));
  for (const std::size_t i : {0u, 3u}) {
    EXPECT_EQ(as<gdd::Reach>(goals, i).p_WTarget, reach.p_WTarget);
    EXPECT_EQ(as<gdd::Reach>(goals, i).p_FP, reach.p_FP);
    EXPECT_EQ(as<gdd::Reach>(goals, i).weight, reach.weight);
    EXPECT_EQ(as<gdd::Reach>(goals, i).stiffness, reach.stiffness);
    EXPECT_EQ(as<gdd::Reach>(goals, i).damping, reach.damping);
  }
  EXPECT_FALSE(as<gdd::Reach>(goals, 0).minimumJerk);
  ASSERT_TRUE(as<gdd::Reach>(goals, 3).minimumJerk);
  EXPECT_EQ(as<gdd::Reach>(goals, 3).minimumJerk->duration, gdd::MinimumJerk().duration);
  EXPECT_EQ(as<gdd::Reach>(goals, 3).minimumJerk->startTime, gdd::MinimumJerk().startTime);

  const gdd::Posture posture(sampleState().q);
  EXPECT_EQ(as<gdd::Posture>(goals, 1).q, posture.q);
  EXPECT_EQ(as<gdd::Posture>(goals, 1).weight, posture.weight);
  EXPECT_EQ(as<gdd::Posture>(goals, 1).stiffness, posture.stiffness);
  EXPECT_EQ(as<gdd::Posture>(goals, 1).damping, posture.damping);

  EXPECT_EQ(as<gdd::VirtualDamping>(goals, 2).weight, gdd::VirtualDamping().weight);
  EXPECT_EQ(as<gdd::VirtualDamping>(goals, 2).rate, gdd::VirtualDamping().rate);
}

TEST(Goals, NoDampingIsAdded) {
  EXPECT_EQ(read("goals:\n  - reach: {link: arm, target: [1, 2, 3]}\n").size(), 1u);
}

TEST(Goals, MayBeSharedByAnchors) {
  const Goals goals =
      read("goals:\n  - &g {reach: {link: arm, target: &p [1, 2, 3], point: *p}}\n  - *g\n");
  ASSERT_EQ(goals.size(), 2u);
  EXPECT_EQ(as<gdd::Reach>(goals, 1).p_FP, Vector3(1.0, 2.0, 3.0));
}

TEST(Goals, OfTheProjectFitItsRobots) {
  const std::filesystem::path data = std::filesystem::path(SOFTGAUSS_SOURCE_DIR) / "data";
  const Model humanoid = loadUrdf(data / "robots/humanoid.urdf");
  EXPECT_EQ(readGoals(data / "goals/stand_and_reach.yaml", humanoid, State(humanoid)).size(), 2u);
  EXPECT_EQ(readGoals(data / "goals/shift_weight.yaml", humanoid, State(humanoid)).size(), 5u);
  EXPECT_EQ(readGoals(data / "goals/move_pressure.yaml", humanoid, State(humanoid)).size(), 4u);
  const Model arm = loadUrdf(data / "robots/arm.urdf");
  EXPECT_EQ(readGoals(data / "goals/arm_reach.yaml", arm, State(arm)).size(), 2u);
}

/// What reading the text ends in; the file's name without its folder.
std::string errorOf(const std::string& text, const Model& model = sampleModel()) {
  const TempFolder folder;
  const std::string file = folder.write("bad.yaml", text).string();
  try {
    readGoals(file, model, State(model));
  } catch (const ModelError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(file)) << message;
    return message.substr(file.size() - std::string("bad.yaml").size());
  }
  return "no error";
}

struct BadGoal {
  const char* name;
  const char* from;  ///< replaced in the sample
  const char* to;
  const char* message;
};

void PrintTo(const BadGoal& bad, std::ostream* out) { *out << bad.name; }

class BadGoals : public testing::TestWithParam<BadGoal> {};

TEST_P(BadGoals, AreRefusedWithFileLineAndKey) {
  const BadGoal& bad = GetParam();
  EXPECT_EQ(errorOf(with(kSampleGoals, bad.from, bad.to)), bad.message);
}

const BadGoal kBadGoals[] = {
    // Keys
    {"UnknownTopKey", "goals:", "version: 1\ngoals:",
     "bad.yaml:2: key 'version': found an unknown key, expected one of goals, control_cost"},
    {"MisspeltTopKey", "goals:", "gaols:",
     "bad.yaml:2: key 'gaols': found an unknown key, expected one of goals, control_cost, did you "
     "mean 'goals'?"},
    {"UnknownKey", "weight: 7", "wieght: 7",
     "bad.yaml:4: goal 1 'reach': key 'wieght': found an unknown key, expected one of link, "
     "target, trajectory, point, rpy, quaternion, weight, rotation_weight, metric, stiffness, "
     "damping, minimum_jerk, start, end, did you mean 'weight'?"},
    {"UnknownNestedKey", "duration: 1.5", "time: 1.5",
     "bad.yaml:5: goal 1 'reach': key 'minimum_jerk.time': found an unknown key, expected one of "
     "duration, start"},
    {"KeyTwice", "rate: 3", "weight: 3",
     "bad.yaml:9: goal 3 'damping': key 'weight': found a second time, first in line 8; "
     "expected once"},
    {"JointTwice", "{shoulder: 0.8}", "{shoulder: 0.8, shoulder: 0.8}",
     "bad.yaml:6: goal 2 'posture': key 'joints.shoulder': found a second time, first in line 6; "
     "expected once"},
    {"GoalsTwice", "goals:", "goals: []\ngoals:",
     "bad.yaml:3: key 'goals': found a second time, first in line 2; expected once"},
    {"KeyIsAList", "rate: 3", "[1, 2]: 3",
     "bad.yaml:9: goal 3 'damping': key: found a list of 2, expected a name"},
    {"KeyIsNull", "rate: 3", "~: 3",
     "bad.yaml:9: goal 3 'damping': key: found nothing, expected a name"},
    {"NoLink", "link: arm, ", "",
     "bad.yaml:3: goal 1 'reach': key 'link': found no such key, expected the name of a link"},
    {"NoTarget", "target: [0.5, -1, 1.5e-1], ", "",
     "bad.yaml:3: goal 1 'reach': key 'target': found no such key, expected three numbers "
     "[x, y, z], or trajectory"},
    // Numbers
    {"NegativeWeight", "weight: 7", "weight: -7",
     "bad.yaml:4: goal 1 'reach': key 'weight': found '-7', expected a finite number >= 0"},
    {"NegativeStiffness", "stiffness: 11", "stiffness: -1e-9",
     "bad.yaml:6: goal 2 'posture': key 'stiffness': found '-1e-9', expected a finite number >= 0"},
    {"NegativeDamping", "damping: 12", "damping: -12",
     "bad.yaml:6: goal 2 'posture': key 'damping': found '-12', expected a finite number >= 0"},
    {"NegativeRate", "rate: 3", "rate: -3",
     "bad.yaml:9: goal 3 'damping': key 'rate': found '-3', expected a finite number >= 0"},
    {"NoDuration", "duration: 1.5", "duration: 0",
     "bad.yaml:5: goal 1 'reach': key 'minimum_jerk.duration': found '0', expected a finite number "
     "> 0"},
    {"NotANumber", "weight: 7", "weight: .nan",
     "bad.yaml:4: goal 1 'reach': key 'weight': found '.nan', expected a finite number >= 0"},
    {"Infinite", "start: 0.25", "start: .inf",
     "bad.yaml:5: goal 1 'reach': key 'minimum_jerk.start': found '.inf', expected a finite "
     "number"},
    {"BeyondDouble", "weight: 7", "weight: 1e999",
     "bad.yaml:4: goal 1 'reach': key 'weight': found '1e999', expected a finite number >= 0"},
    {"BeyondSense", "weight: 7", "weight: 1e200",
     "bad.yaml:4: goal 1 'reach': key 'weight': found '1e200', expected a finite number >= 0 of "
     "size 1e+12 at most"},
    {"BeyondSenseBelow", "start: 0.25", "start: -1.1e12",
     "bad.yaml:5: goal 1 'reach': key 'minimum_jerk.start': found '-1.1e12', expected a finite "
     "number of size 1e+12 at most"},
    {"BeyondSenseInAVector", "[0.1, 0, 0]", "[0.1, 0, -1e200]",
     "bad.yaml:3: goal 1 'reach': key 'point': found '-1e200' as number 3, expected numbers of "
     "size 1e+12 at most"},
    {"JointBeyondSense", "shoulder: 0.8", "shoulder: 1e200",
     "bad.yaml:6: goal 2 'posture': key 'joints.shoulder': found '1e200', expected a finite number "
     "of size 1e+12 at most"},
    {"DurationBelowSense", "duration: 1.5", "duration: 1e-9",
     "bad.yaml:5: goal 1 'reach': key 'minimum_jerk.duration': found 1e-09 s, expected at least "
     "1e-06 s"},
    {"HalfNumber", "weight: 7", "weight: 7kg",
     "bad.yaml:4: goal 1 'reach': key 'weight': found '7kg', expected a finite number >= 0"},
    {"QuotedNumber", "weight: 7", "weight: \"7\"",
     "bad.yaml:4: goal 1 'reach': key 'weight': found the text '7', expected a finite number >= 0"},
    {"NumberIsAList", "weight: 7", "weight: [7]",
     "bad.yaml:4: goal 1 'reach': key 'weight': found a list of 1, expected a finite number >= 0"},
    {"NumberIsMissing", "weight: 7", "weight: ",
     "bad.yaml:4: goal 1 'reach': key 'weight': found nothing, expected a finite number >= 0"},
    // Vectors
    {"TwoNumbers", "[0.1, 0, 0]", "[0.1, 0]",
     "bad.yaml:3: goal 1 'reach': key 'point': found a list of 2, expected three numbers "
     "[x, y, z]"},
    {"FourNumbers", "[0.5, -1, 1.5e-1]", "[0.5, -1, 1, 5e-1]",
     "bad.yaml:3: goal 1 'reach': key 'target': found a list of 4, expected three numbers "
     "[x, y, z]"},
    {"VectorIsANumber", "[0.1, 0, 0]", "0.1",
     "bad.yaml:3: goal 1 'reach': key 'point': found '0.1', expected three numbers [x, y, z]"},
    {"WordInVector", "[0.1, 0, 0]", "[0.1,\n zero, 0]",
     "bad.yaml:4: goal 1 'reach': key 'point': found 'zero' as number 2, expected three finite "
     "numbers [x, y, z]"},
    {"NanInVector", "[0.1, 0, 0]", "[0.1, 0, nan]",
     "bad.yaml:3: goal 1 'reach': key 'point': found 'nan' as number 3, expected three finite "
     "numbers [x, y, z]"},
    // Names
    {"UnknownLink", "link: arm", "link: amr",
     "bad.yaml:3: goal 1 'reach': key 'link': found 'amr', expected a link of model 'sample', "
     "did you mean 'arm'? there are: base, arm"},
    {"LinkIsAMap", "link: arm", "link: {name: arm}",
     "bad.yaml:3: goal 1 'reach': key 'link': found a map, expected a name"},
    {"UnknownJoint", "shoulder: 0.8", "sholder: 0.8",
     "bad.yaml:6: goal 2 'posture': key 'joints.sholder': found an unknown joint, expected one of "
     "model 'sample', did you mean 'shoulder'? there are: shoulder"},
    {"FloatingJoint", "shoulder: 0.8", "base: 0.8",
     "bad.yaml:6: goal 2 'posture': key 'joints.base': found a joint of 6 degrees of freedom, "
     "expected a revolute, continuous or prismatic one"},
    {"JointAtNan", "shoulder: 0.8", "shoulder: nan",
     "bad.yaml:6: goal 2 'posture': key 'joints.shoulder': found 'nan', expected a finite number"},
    {"JointsAreAList", "{shoulder: 0.8}", "[0.8]",
     "bad.yaml:6: goal 2 'posture': key 'joints': found a list of 1, expected a map {…}"},
    {"MinimumJerkIsANumber", "{duration: 1.5, start: 0.25}", "1.5",
     "bad.yaml:5: goal 1 'reach': key 'minimum_jerk': found '1.5', expected a map {…}"},
    // Kinds
    {"UnknownKind", "posture:", "posutre:",
     "bad.yaml:6: goal 2: found the unknown kind 'posutre', expected one of reach, "
     "link_acceleration, look_at, hold, keep_clear, posture, joint_posture, joint_velocity, "
     "acceleration, damping, effort, center_of_mass and 4 more, did you mean 'posture'?"},
    {"GoalIsAWord", "- posture", "- damping\n  - posture",
     "bad.yaml:6: goal 2: found 'damping', expected kind: {…}, the kind one of reach, "
     "link_acceleration, look_at, hold, keep_clear, posture, joint_posture, joint_velocity, "
     "acceleration, damping, effort, center_of_mass and 4 more"},
    {"KeysNotIndented", "      weight: 0.5\n      rate: 3", "    weight: 0.5\n    rate: 3",
     "bad.yaml:7: goal 3: found 3 keys (damping, weight, rate), expected one, the kind, whose own "
     "keys are in {…} or indented below it"},
    {"KindWithoutKeys", "      weight: 0.5\n      rate: 3\n", "",
     "bad.yaml:7: goal 3 'damping': found nothing, expected a map {…} with keys of weight, rate, "
     "metric"},
    {"EmptyGoal", "- posture", "- {}\n  - posture",
     "bad.yaml:6: goal 2: found 0 keys (), expected one, the kind, whose own keys are in {…} or "
     "indented below it"},
};

INSTANTIATE_TEST_SUITE_P(Goals, BadGoals, testing::ValuesIn(kBadGoals),
                         [](const auto& test) { return test.param.name; });

TEST(GoalsFile, WithoutAListOfGoalsIsRefused) {
  EXPECT_EQ(errorOf(""), "bad.yaml:1: file: is empty, expected goals: [...]");
  EXPECT_EQ(errorOf("# only a comment\n"), "bad.yaml:1: file: is empty, expected goals: [...]");
  EXPECT_EQ(errorOf("- damping: {}\n"),
            "bad.yaml:1: file: found a list of 1, expected goals: [...]");
  EXPECT_EQ(errorOf("\n{}\n"),
            "bad.yaml:2: key 'goals': found no such key, expected a list of goals");
  EXPECT_EQ(errorOf("goals:\n"),
            "bad.yaml:1: key 'goals': found nothing, expected a list of at least one goal");
  EXPECT_EQ(errorOf("goals: []\n"),
            "bad.yaml:1: key 'goals': found a list of 0, expected a list of at least one goal");
  EXPECT_EQ(errorOf("goals: {damping: {}}\n"),
            "bad.yaml:1: key 'goals': found a map, expected a list of at least one goal");
}

TEST(GoalsFile, ThatIsNoYamlIsRefused) {
  EXPECT_TRUE(errorOf("goals:\n  - reach: {link: arm\n").starts_with("bad.yaml:3: YAML: cannot be"))
      << errorOf("goals:\n  - reach: {link: arm\n");
  EXPECT_EQ(errorOf("goals:\n\t- damping: {}\n").substr(0, 33),
            "bad.yaml:2: YAML: cannot be read:");
  EXPECT_EQ(errorOf(std::string("goals:\n\0", 8)),
            "bad.yaml:2: YAML: found a control character, expected text in UTF-8");
  const std::string more =
      "found more behind the end of the document, expected the end of the file";
  EXPECT_EQ(errorOf(kSampleGoals + "---\ngoals: []\n"), "bad.yaml:10: YAML: " + more);
  EXPECT_EQ(errorOf("\n, goals: []\n"), "bad.yaml:2: YAML: " + more);
  EXPECT_NE(errorOf(std::string(100000, '[')), "no error");
}

TEST(GoalsFile, ThatIsNotThereIsNamed) {
  try {
    readGoals("no/such/goals.yaml", sampleModel(), sampleState());
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_STREQ(error.what(),
                 "no/such/goals.yaml: file: cannot be read: No such file or directory, expected a "
                 "YAML file of goals");
  }
}

TEST(GoalsFile, MayNotMoveWhatIsFixedToTheWorld) {
  const Model arm =
      loadUrdf(std::filesystem::path(SOFTGAUSS_SOURCE_DIR) / "data" / "robots" / "arm.urdf");
  EXPECT_EQ(errorOf("goals:\n  - reach: {link: base, target: [1, 0, 0]}\n", arm),
            "bad.yaml:2: goal 1 'reach': key 'link': found 'base', which is fixed to the world, "
            "expected a link that moves");
}

/// Flips bits, deletes and repeats parts, inserts what means something in YAML, truncates.
std::string mutated(std::string text, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  for (std::size_t edits = 1 + below(3); edits > 0 && !text.empty(); --edits) {
    const std::size_t at = below(text.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(12, text.size() - at));
    switch (below(5)) {
      case 0:
        text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(at, text.substr(at, length));
        break;
      case 3: {
        const char* const scraps[] = {"-",  "9",  "nan", "1e308", "{",  "}", "[",  "]",   ": ",
                                      ", ", "\"", "'",   "&a ",   "*a", "#", "\n", "---", "!t "};
        text.insert(at, scraps[below(std::size(scraps))]);
        break;
      }
      default:
        if (below(4) == 0) text.resize(at);
        break;
    }
  }
  return text;
}

TEST(GoalsFuzz, MutatedFilesLoadOrThrowModelError) {
  const TempFolder folder;
  const State initial = sampleState();
  std::mt19937 random(20240602);
  int loaded = 0, refused = 0;
  for (int i = 0; i < 500; ++i) {
    const std::string text = mutated(kSampleGoals, random);
    const auto file = folder.write("fuzz.yaml", text);
    try {
      const Goals goals = readGoals(file, sampleModel(), initial);
      ++loaded;
      ASSERT_FALSE(goals.empty()) << text;
      for (const auto& goal : goals) {
        if (const auto* reach = dynamic_cast<const gdd::Reach*>(goal.get())) {
          ASSERT_TRUE(reach->p_WTarget.allFinite() && reach->p_FP.allFinite()) << text;
          ASSERT_TRUE(std::isfinite(reach->weight) && reach->weight >= 0.0) << text;
        }
        if (const auto* posture = dynamic_cast<const gdd::Posture*>(goal.get())) {
          ASSERT_TRUE(posture->q.allFinite()) << text;
        }
      }
    } catch (const ModelError& error) {
      ++refused;
      ASSERT_TRUE(std::string(error.what()).starts_with(file.string())) << error.what() << text;
    } catch (const std::exception& error) {
      FAIL() << error.what() << "\n" << text;
    }
  }
  // Both ends are exercised.
  EXPECT_GT(loaded, 30);
  EXPECT_GT(refused, 300);
}

}  // namespace
}  // namespace softgauss::io

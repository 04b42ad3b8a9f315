// SPDX-License-Identifier: Apache-2.0
/// The kinds of goal beyond reach, posture and damping: what their keys mean, and what is refused.

#include <gtest/gtest.h>

#include "gdd/gdd.hpp"
#include "io/goals.hpp"
#include "io/urdf.hpp"
#include "sample_urdf.hpp"
#include "temp_folder.hpp"

namespace softgauss::io {
namespace {

using Goals = std::vector<std::unique_ptr<gdd::Goal>>;

const Model& sampleModel() {
  static const Model model = [] {
    const TempFolder folder;
    return loadUrdf(folder.write("sample.urdf", kSampleUrdf));
  }();
  return model;
}

/// Away from zero, so that references to it show.
State sampleState() {
  State state(sampleModel());
  state.q.head<3>() = Vector3(0.3, -0.2, 1.0);
  state.q.tail<1>()[0] = 0.4;
  return state;
}

/// The goals of the items, each on a line of its own from line 2 on.
Goals read(const std::string& items) {
  const TempFolder folder;
  return readGoals(folder.write("goals.yaml", "goals:\n" + items), sampleModel(), sampleState());
}

template <class Kind>
std::unique_ptr<Kind> readOne(const std::string& item) {
  Goals goals = read("  - " + item + "\n");
  EXPECT_EQ(goals.size(), 1u);
  Kind* kind = dynamic_cast<Kind*>(goals.at(0).release());
  EXPECT_NE(kind, nullptr) << item;
  return std::unique_ptr<Kind>(kind);
}

/// What reading the item ends in, after `goals.yaml:2: goal 1 `.
std::string errorOf(const std::string& item) {
  const std::string start = "goals.yaml:2: goal 1 ";
  try {
    read("  - " + item + "\n");
  } catch (const ModelError& error) {
    const std::string message = error.what();
    const std::size_t at = message.find(start);
    if (at == std::string::npos) return message;
    return message.substr(at + start.size());
  }
  return "no error";
}

TEST(GoalTimesInFiles, AreOfEveryKind) {
  const auto goal = readOne<gdd::VirtualDamping>("damping: {start: -1, end: 2.5}");
  EXPECT_EQ(goal->startTime, -1.0);
  EXPECT_EQ(goal->endTime, 2.5);
  const auto forever = readOne<gdd::VirtualDamping>("damping: {}");
  EXPECT_TRUE(forever->actsAt(-1e300) && forever->actsAt(1e300));
  EXPECT_EQ(errorOf("damping: {start: 1, end: 1}"),
            "'damping': key 'end': found 1 s, expected a time after the start at 1 s");
  EXPECT_EQ(errorOf("damping: {end: .inf}"),
            "'damping': key 'end': found '.inf', expected a finite number");
}

TEST(JointGoalsInFiles, ArriveWithTheirValues) {
  const auto posture = readOne<gdd::JointPosture>(
      "joint_posture: {joints: {shoulder: 0.8}, weight: 1, stiffness: 2, damping: 3}");
  ASSERT_EQ(posture->targets.size(), 1u);
  EXPECT_EQ(posture->targets[0].body, sampleModel().findJoint("shoulder"));
  EXPECT_EQ(posture->targets[0].value, 0.8);
  EXPECT_EQ(posture->weight, 1.0);
  EXPECT_EQ(posture->stiffness, 2.0);
  EXPECT_EQ(posture->damping, 3.0);
  const auto acceleration =
      readOne<gdd::JointAcceleration>("acceleration: {joints: {shoulder: -4}, weight: 5}");
  ASSERT_EQ(acceleration->targets.size(), 1u);
  EXPECT_EQ(acceleration->targets[0].value, -4.0);
  EXPECT_EQ(acceleration->weight, 5.0);
  EXPECT_EQ(readOne<gdd::JointAcceleration>("acceleration: {joints: {shoulder: 0}}")->weight,
            gdd::JointAcceleration().weight);
}

TEST(JointGoalsInFiles, BadOnesAreRefused) {
  EXPECT_EQ(errorOf("acceleration: {}"),
            "'acceleration': key 'joints': found no such key, expected a map of joints, {joint: "
            "number}");
  EXPECT_EQ(errorOf("joint_posture: {joints: {}}"),
            "'joint_posture': key 'joints': found an empty map, expected at least one joint");
  EXPECT_EQ(errorOf("acceleration: {joints: {sholder: 1}}"),
            "'acceleration': key 'joints.sholder': found an unknown joint, expected one of model "
            "'sample', did you mean 'shoulder'?");
  EXPECT_EQ(errorOf("acceleration: {joints: {shoulder: 1}, weight: -1}"),
            "'acceleration': key 'weight': found '-1', expected a finite number >= 0");
  EXPECT_EQ(errorOf("acceleration: {joints: {shoulder: 1}, stiffness: 1}"),
            "'acceleration': key 'stiffness': found an unknown key, expected one of joints, "
            "weight, start, end");
}

}  // namespace
}  // namespace softgauss::io

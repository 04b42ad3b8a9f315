// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The kinds of goal that a file may hold: for each its keys and what reads them.
///
/// To add a kind: write its function in one of the goal_*.cpp, name it and its keys in
/// goal_kinds.cpp, and show it in docs/reference/goals.md.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "softgauss/engine/model/state.hpp"
#include "softgauss/gdd/goal.hpp"
#include "softgauss/io/detail/yaml.hpp"
#include "softgauss/io/goals.hpp"

namespace softgauss::io::detail {

using GoalPointer = std::unique_ptr<gdd::Goal>;

/// What the goals are about.
struct GoalScene {
  const Model& model;
  const State& initial;
  const DistancesMaker& distances;
};

struct GoalKind {
  std::string name;
  std::vector<std::string> keys;  ///< without `start` and `end`, which every kind has
  GoalPointer (*read)(const YamlMap& keys, const GoalScene& scene);
};

const std::vector<GoalKind>& goalKinds();

// ---- goal_parts.cpp: what several kinds read ----------------------------------------------------

/// The link that the entry names; it must move.
std::string movingLink(const YamlMap& keys, const YamlMap::Entry& entry, const Model& model);

/// The bodies that the joints of the map carry, in its order; each joint must have one degree of
/// freedom.
std::vector<std::pair<int, double>> readJoints(const YamlMap& joints, const Model& model);

/// The robot of the key `link`; without it the first that has an actuated joint.
int readRobot(const YamlMap& keys, const Model& model);

/// Some of the letters x, y, z.
std::array<bool, 3> readAxes(const YamlMap& keys, const YamlMap::Entry& entry);

/// A minimum-jerk line that follows another reach of the same point, of a goal that starts later,
/// begins at the target of that one, and not where the point was at first.
void joinLines(const std::vector<GoalPointer>& goals);

/// The key `weight` of a goal that has a default: what a file gives stays.
template <class WeightedGoal>
void readWeight(const YamlMap& keys, WeightedGoal& goal) {
  if (!keys.find("weight")) return;
  keys.read("weight", goal.weight, Range::notNegative);
  goal.defaultWeight.giveUp();
}

/// Pose of a frame in the initial state.
Transform initialPose(const GoalScene& scene, int frame);

// ---- One function for each kind -----------------------------------------------------------------

GoalPointer readReach(const YamlMap& keys, const GoalScene& scene);
GoalPointer readLinkAcceleration(const YamlMap& keys, const GoalScene& scene);
GoalPointer readLookAt(const YamlMap& keys, const GoalScene& scene);
GoalPointer readHold(const YamlMap& keys, const GoalScene& scene);
GoalPointer readKeepClear(const YamlMap& keys, const GoalScene& scene);
GoalPointer readPosture(const YamlMap& keys, const GoalScene& scene);
GoalPointer readJointPosture(const YamlMap& keys, const GoalScene& scene);
GoalPointer readJointVelocity(const YamlMap& keys, const GoalScene& scene);
GoalPointer readAcceleration(const YamlMap& keys, const GoalScene& scene);
GoalPointer readDamping(const YamlMap& keys, const GoalScene& scene);
GoalPointer readEffort(const YamlMap& keys, const GoalScene& scene);
GoalPointer readCenterOfMass(const YamlMap& keys, const GoalScene& scene);
GoalPointer readMomentum(const YamlMap& keys, const GoalScene& scene);
GoalPointer readCapturePoint(const YamlMap& keys, const GoalScene& scene);
GoalPointer readContactForce(const YamlMap& keys, const GoalScene& scene);
GoalPointer readCenterOfPressure(const YamlMap& keys, const GoalScene& scene);

}  // namespace softgauss::io::detail

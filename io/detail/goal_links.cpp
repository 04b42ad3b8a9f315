// SPDX-License-Identifier: Apache-2.0
/// Goals of links: reach, link_acceleration, look_at, hold.

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/gdd/goals/hold.hpp"
#include "softgauss/gdd/goals/link_acceleration.hpp"
#include "softgauss/gdd/goals/look_at.hpp"
#include "softgauss/gdd/goals/reach.hpp"
#include "softgauss/io/detail/goal_kinds.hpp"
#include "softgauss/io/detail/goal_trajectory.hpp"
#include "softgauss/io/detail/scene_parts.hpp"

namespace softgauss::io::detail {
namespace {

/// The line of Flash and Hogan from where the goal's point is at first. It begins when the goal
/// does, unless the file says otherwise.
gdd::MinimumJerk readMinimumJerk(const YamlMap& keys, double goalStart, const gdd::Reach& goal,
                                 const GoalScene& scene) {
  keys.expectOnly({"duration", "start"});
  gdd::MinimumJerk line;
  line.startTime = std::max(line.startTime, goalStart);
  keys.read("duration", line.duration, Range::positive);
  if (line.duration < kShortestPiece)
    keys.fail(*keys.find("duration"),
              fmt::format("found {} s, expected at least {:g} s", line.duration, kShortestPiece));
  keys.read("start", line.startTime, Range::any);
  const Transform start = initialPose(scene, goal.frame);
  line.p_start = start * goal.p_FP;
  line.R_start = start.R;
  return line;
}

/// Metric, weight and rotation weight of a goal, whose defaults depend on the first. `turns`: it
/// asks for a rotation; `how` a file says so.
template <class Goal>
void readWeights(const YamlMap& keys, bool turns, const std::string& how, Goal& goal) {
  constexpr double kConsistentWeight = 1000.0;
  const YamlMap::Entry* metric = keys.find("metric");
  const bool consistent =
      metric && keys.choice(*metric, {"euclidean", "consistent"}) == "consistent";
  if (consistent) {
    goal.metric = gdd::LinkMetric::consistent;
    goal.weight = kConsistentWeight;
    goal.defaultWeight = gdd::DefaultWeight(kConsistentWeight);
  }
  readWeight(keys, goal);
  goal.rotationWeight = (consistent ? 1.0 : gdd::kRotationWeightPerWeight) * goal.weight;
  goal.defaultRotationWeight = gdd::DefaultWeight(goal.rotationWeight);
  if (keys.find("weight") || keys.find("rotation_weight")) goal.defaultRotationWeight.giveUp();
  keys.read("rotation_weight", goal.rotationWeight, Range::notNegative);
  const YamlMap::Entry* rotation = keys.find("rotation_weight");
  if (rotation && !turns) keys.fail(*rotation, how);
}

std::string requiredLink(const YamlMap& keys, const Model& model) {
  return movingLink(keys, keys.required("link", "the name of a link"), model);
}

}  // namespace

GoalPointer readReach(const YamlMap& keys, const GoalScene& scene) {
  const std::string link = requiredLink(keys, scene.model);
  auto goal = std::make_unique<gdd::Reach>(scene.model, link, Vector3::Zero());
  readPlaceTarget(keys, true, *goal);
  keys.read("point", goal->p_FP);
  if (keys.find("rpy") || keys.find("quaternion")) goal->R_WTarget = readPose(keys).R;
  readWeights(keys, goal->R_WTarget.has_value(),
              "found without an orientation, expected rpy or quaternion beside it", *goal);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  double start = -kInfinity;
  keys.read("start", start, Range::any);
  if (const auto* line = keys.find("minimum_jerk"))
    goal->minimumJerk = readMinimumJerk(keys.map(*line), start, *goal, scene);
  return goal;
}

void joinLines(const std::vector<GoalPointer>& goals) {
  std::vector<gdd::Reach*> reaches;
  for (const GoalPointer& goal : goals)
    if (auto* reach = dynamic_cast<gdd::Reach*>(goal.get())) reaches.push_back(reach);
  std::stable_sort(reaches.begin(), reaches.end(), [](const gdd::Reach* a, const gdd::Reach* b) {
    return a->startTime < b->startTime;
  });
  for (auto next = reaches.begin(); next != reaches.end(); ++next) {
    gdd::Reach& goal = **next;
    if (!goal.minimumJerk) continue;
    for (auto it = reaches.begin(); it != next; ++it) {
      const gdd::Reach& before = **it;
      if (before.frame != goal.frame || before.p_FP != goal.p_FP) continue;
      if (before.startTime == goal.startTime) continue;
      goal.minimumJerk->p_start = before.targetAt(goal.minimumJerk->startTime).p;
      if (before.R_WTarget) goal.minimumJerk->R_start = *before.R_WTarget;
    }
  }
}

GoalPointer readLinkAcceleration(const YamlMap& keys, const GoalScene& scene) {
  const std::string link = requiredLink(keys, scene.model);
  const Vector3 linear = keys.vector3(keys.required("linear", "three numbers [x, y, z]"));
  auto goal = std::make_unique<gdd::LinkAcceleration>(scene.model, link, linear);
  keys.read("point", goal->p_FP);
  if (const auto* entry = keys.find("angular")) goal->angular = keys.vector3(*entry);
  readWeights(keys, goal->angular.has_value(),
              "found without a rotation, expected angular beside it", *goal);
  return goal;
}

GoalPointer readLookAt(const YamlMap& keys, const GoalScene& scene) {
  const std::string link = requiredLink(keys, scene.model);
  Vector3 axis = Vector3::UnitX();
  keys.read("axis", axis);
  if (axis.stableNorm() == 0.0)
    keys.fail(*keys.find("axis"), "found a vector of length 0, expected a direction");
  auto goal = std::make_unique<gdd::LookAt>(scene.model, link, Vector3::Zero(), axis);
  readPlaceTarget(keys, true, *goal);
  keys.read("point", goal->p_FP);
  readWeight(keys, *goal);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  return goal;
}

GoalPointer readHold(const YamlMap& keys, const GoalScene& scene) {
  auto goal = std::make_unique<gdd::Hold>(scene.model, requiredLink(keys, scene.model));
  goal->wholeLink = !keys.find("point");
  keys.read("point", goal->p_FP);
  readWeight(keys, *goal);
  goal->rotationWeight = gdd::kRotationWeightPerWeight * goal->weight;
  if (keys.find("weight") || keys.find("rotation_weight")) goal->defaultRotationWeight.giveUp();
  keys.read("rotation_weight", goal->rotationWeight, Range::notNegative);
  const YamlMap::Entry* rotation = keys.find("rotation_weight");
  if (rotation && !goal->wholeLink)
    keys.fail(*rotation, "found beside a point, expected the whole link to be held");
  keys.read("rate", goal->rate, Range::notNegative);
  return goal;
}

}  // namespace softgauss::io::detail

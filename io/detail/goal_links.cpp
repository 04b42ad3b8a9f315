// SPDX-License-Identifier: Apache-2.0
/// Goals of links: reach.

#include "gdd/goals/reach.hpp"
#include "io/detail/goal_kinds.hpp"

namespace softgauss::io::detail {
namespace {

/// The line of Flash and Hogan from where the goal's point is at first.
gdd::MinimumJerk readMinimumJerk(const YamlMap& keys, const gdd::Reach& goal,
                                 const GoalScene& scene) {
  keys.expectOnly({"duration", "start"});
  gdd::MinimumJerk line;
  keys.read("duration", line.duration, Range::positive);
  keys.read("start", line.startTime, Range::any);
  line.p_start = initialPose(scene, goal.frame) * goal.p_FP;
  return line;
}

}  // namespace

GoalPointer readReach(const YamlMap& keys, const GoalScene& scene) {
  const std::string link =
      movingLink(keys, keys.required("link", "the name of a link"), scene.model);
  const Vector3 target = keys.vector3(keys.required("target", "three numbers [x, y, z]"));
  auto goal = std::make_unique<gdd::Reach>(scene.model, link, target);
  keys.read("point", goal->p_FP);
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  if (const auto* line = keys.find("minimum_jerk"))
    goal->minimumJerk = readMinimumJerk(keys.map(*line), *goal, scene);
  return goal;
}

}  // namespace softgauss::io::detail

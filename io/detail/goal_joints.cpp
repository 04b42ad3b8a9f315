// SPDX-License-Identifier: Apache-2.0
/// Goals of joints: posture, joint_posture, joint_velocity, acceleration, damping, effort.

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/gdd/goals/effort.hpp"
#include "softgauss/gdd/goals/joint_velocity.hpp"
#include "softgauss/gdd/goals/posture.hpp"
#include "softgauss/gdd/goals/virtual_damping.hpp"
#include "softgauss/io/detail/goal_kinds.hpp"
#include "softgauss/io/detail/goal_trajectory.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

/// The joints of the key `joints`, of which there must be one.
std::vector<gdd::JointTarget> requiredJoints(const YamlMap& keys, const Model& model) {
  const YamlMap::Entry& entry = keys.required("joints", "a map of joints, {joint: number}");
  std::vector<gdd::JointTarget> targets;
  for (const auto& [body, value] : readJoints(keys.map(entry), model))
    targets.push_back({body, value});
  if (targets.empty()) keys.fail(entry, "found an empty map, expected at least one joint");
  return targets;
}

}  // namespace

GoalPointer readPosture(const YamlMap& keys, const GoalScene& scene) {
  auto goal = std::make_unique<gdd::Posture>(scene.initial.q);
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  if (const auto* joints = keys.find("joints"))
    for (const auto& [body, value] : readJoints(keys.map(*joints), scene.model))
      goal->q[scene.model.bodies[static_cast<std::size_t>(body)].q] = value;
  goal->moving = readJointTrajectory(keys, scene.model);
  return goal;
}

GoalPointer readJointPosture(const YamlMap& keys, const GoalScene& scene) {
  auto goal = std::make_unique<gdd::JointPosture>();
  goal->targets = readJointTrajectory(keys, scene.model);
  if (goal->targets.empty())
    goal->targets = requiredJoints(keys, scene.model);
  else if (const auto* joints = keys.find("joints"))
    keys.fail(*joints, "found beside trajectory, expected one of joints, trajectory");
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  return goal;
}

GoalPointer readJointVelocity(const YamlMap& keys, const GoalScene& scene) {
  auto goal = std::make_unique<gdd::JointVelocity>();
  goal->targets = requiredJoints(keys, scene.model);
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("rate", goal->rate, Range::notNegative);
  return goal;
}

GoalPointer readAcceleration(const YamlMap& keys, const GoalScene& scene) {
  auto goal = std::make_unique<gdd::JointAcceleration>();
  goal->targets = requiredJoints(keys, scene.model);
  keys.read("weight", goal->weight, Range::notNegative);
  return goal;
}

GoalPointer readDamping(const YamlMap& keys, const GoalScene&) {
  auto goal = std::make_unique<gdd::VirtualDamping>();
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("rate", goal->rate, Range::notNegative);
  const YamlMap::Entry* metric = keys.find("metric");
  if (metric && keys.choice(*metric, {"inertia", "inverse_inertia"}) == "inverse_inertia")
    goal->metric = gdd::DampingMetric::inverseInertia;
  return goal;
}

GoalPointer readEffort(const YamlMap& keys, const GoalScene& scene) {
  const Model& model = scene.model;
  auto goal = std::make_unique<gdd::Effort>(gdd::Effort::actuatedDofs(model));
  keys.read("weight", goal->weight, Range::notNegative);
  const YamlMap::Entry* entry = keys.find("joints");
  if (!entry) return goal;
  std::vector<std::string> names;
  for (const int dof : goal->dofs)
    names.push_back(model.jointNames[static_cast<std::size_t>(model.dofs[dof].body)]);
  goal->dofs.clear();
  for (const YamlValue& item : keys.list(*entry)) {
    const int body = item.kind == YamlValue::Kind::text ? model.findJoint(item.text) : -1;
    const int dof = body < 0 ? -1 : model.bodies[static_cast<std::size_t>(body)].v;
    if (body < 0 || !model.dofs[static_cast<std::size_t>(dof)].actuated)
      keys.fail(*entry, fmt::format("found {}, expected actuated joints of model '{}'{}",
                                    item.described(), model.name, suggestion(item.text, names)));
    if (std::find(goal->dofs.begin(), goal->dofs.end(), dof) != goal->dofs.end())
      keys.fail(*entry, fmt::format("found {} twice, expected once", item.described()));
    goal->dofs.push_back(dof);
  }
  if (goal->dofs.empty()) keys.fail(*entry, "found an empty list, expected at least one joint");
  return goal;
}

}  // namespace softgauss::io::detail

// SPDX-License-Identifier: Apache-2.0
/// Goals of a robot as a whole: center_of_mass, momentum, capture_point.

#include "softgauss/gdd/goals/balance.hpp"
#include "softgauss/io/detail/goal_kinds.hpp"
#include "softgauss/io/detail/goal_trajectory.hpp"

namespace softgauss::io::detail {

GoalPointer readCenterOfMass(const YamlMap& keys, const GoalScene& scene) {
  const Model& model = scene.model;
  const int robot = readRobot(keys, model);
  Kinematics kinematics(model);
  MassMatrix inertia(model);
  Centroidal centroidal;
  computeKinematics(model, scene.initial, kinematics);
  computeMassMatrix(model, kinematics, inertia);
  computeCentroidal(model, kinematics, inertia, robot, centroidal);
  auto goal = std::make_unique<gdd::CenterOfMass>(model, robot, centroidal.p_WC);
  readPlaceTarget(keys, false, *goal);
  if (const auto* axes = keys.find("axes")) goal->axes = readAxes(keys, *axes);
  readWeight(keys, *goal);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  return goal;
}

GoalPointer readMomentum(const YamlMap& keys, const GoalScene& scene) {
  auto goal = std::make_unique<gdd::MomentumGoal>(scene.model, readRobot(keys, scene.model));
  keys.read("linear", goal->linear);
  keys.read("angular", goal->angular);
  keys.read("linear_weight", goal->linearWeight, Range::notNegative);
  keys.read("angular_weight", goal->angularWeight, Range::notNegative);
  keys.read("rate", goal->rate, Range::notNegative);
  return goal;
}

GoalPointer readCapturePoint(const YamlMap& keys, const GoalScene& scene) {
  const int robot = readRobot(keys, scene.model);
  auto goal = std::make_unique<gdd::CapturePoint>(scene.model, robot, Vector3::Zero());
  readPlaceTarget(keys, true, *goal);
  readWeight(keys, *goal);
  keys.read("rate", goal->rate, Range::notNegative);
  return goal;
}

}  // namespace softgauss::io::detail

// SPDX-License-Identifier: Apache-2.0
/// Goals of a robot as a whole: center_of_mass, momentum, capture_point.

#include <fmt/format.h>

#include <algorithm>

#include "gdd/goals/balance.hpp"
#include "io/detail/goal_kinds.hpp"
#include "io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

/// The robot of the key `link`; without it the first that has an actuated joint.
int readRobot(const YamlMap& keys, const Model& model) {
  const bool driven = std::any_of(model.dofs.begin(), model.dofs.end(),
                                  [](const Dof& dof) { return dof.actuated; });
  if (driven && !keys.find("link")) return gdd::drivenRobot(model);
  const YamlMap::Entry& entry =
      keys.required("link", "a link of the robot meant, as no joint is actuated");
  const int frame = model.findFrame(movingLink(keys, entry, model));
  const Frame& link = model.frames[static_cast<std::size_t>(frame)];
  return model.bodies[static_cast<std::size_t>(link.body)].robot;
}

std::array<bool, 3> readAxes(const YamlMap& keys, const YamlMap::Entry& entry) {
  const std::string letters = keys.name(entry);
  std::array<bool, 3> axes{};
  bool good = !letters.empty();
  for (const char letter : letters) {
    good = good && letter >= 'x' && letter <= 'z' && !axes[static_cast<std::size_t>(letter - 'x')];
    if (good) axes[static_cast<std::size_t>(letter - 'x')] = true;
  }
  if (!good)
    keys.fail(entry, fmt::format("found {}, expected some of the letters x, y, z, each once",
                                 quotedText(letters)));
  return axes;
}

}  // namespace

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
  keys.read("target", goal->p_WTarget);
  if (const auto* axes = keys.find("axes")) goal->axes = readAxes(keys, *axes);
  keys.read("weight", goal->weight, Range::notNegative);
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
  const Vector3 target = keys.vector3(keys.required("target", "three numbers [x, y, z]"));
  auto goal = std::make_unique<gdd::CapturePoint>(scene.model, robot, target);
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("rate", goal->rate, Range::notNegative);
  return goal;
}

}  // namespace softgauss::io::detail

// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/start_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apps/simulate_gdd/names.hpp"
#include "softgauss/gdd/goals/joints.hpp"
#include "softgauss/gdd/goals/posture.hpp"
#include "softgauss/gdd/gravity_compensation.hpp"
#include "softgauss/io/detail/unit_mistakes.hpp"

namespace softgauss::app {
namespace {

constexpr double kTold = 1.01;  // of the limit

/// Hinges that a goal sends beyond their range to where degrees would be within it.
std::vector<std::string> inDegrees(const Model& model,
                                   const gdd::GoalDirectedController& controller) {
  std::vector<std::string> found;
  const auto look = [&](const gdd::Goal& goal, int body, double value) {
    for (const JointRange& range : model.ranges) {
      if (range.body != body) continue;
      const std::string meant = io::detail::radiansMeant(model, range, value);
      if (!meant.empty())
        found.push_back(fmt::format("{} sends {} to {:.6g}, beyond its range {:.6g} .. {:.6g}{}",
                                    goal.name(), nameText(model.jointNames[idx(body)]), value,
                                    range.lower, range.upper, meant));
    }
  };
  for (const auto& goal : controller.goals) {
    if (const auto* joints = dynamic_cast<const gdd::JointPosture*>(goal.get()))
      for (const gdd::JointTarget& target : joints->targets) look(*goal, target.body, target.value);
    if (const auto* posture = dynamic_cast<const gdd::Posture*>(goal.get()))
      for (int b = 1; b < model.bodyCount(); ++b)
        if (model.bodies[idx(b)].dofs == 1) look(*goal, b, posture->q[model.bodies[idx(b)].q]);
  }
  return found.empty() ? found : std::vector<std::string>{joined(found)};
}

/// Joints that cannot hold the start against gravity.
std::vector<std::string> weakAtStart(const Model& model, const State& state,
                                     const gdd::GoalDirectedController& controller, Data& data) {
  const gdd::ControlLimits& limits = controller.limits;
  gdd::GravityCompensation holding(model);
  VectorX y;
  limits.coordinates(holding.compute(model, state, limits, data), y);
  std::vector<std::string> weak;
  const auto look = [&](int coordinate, const std::string& name, const char* unit) {
    const double bound = y[coordinate] > 0.0 ? limits.upper[coordinate] : -limits.lower[coordinate];
    if (std::abs(y[coordinate]) > kTold * bound)
      weak.push_back(fmt::format("{} needs {:.3g} of {:.3g}{}", nameText(name),
                                 std::abs(y[coordinate]), bound, unit));
  };
  for (int i = 0; i < model.nv; ++i)
    if (model.dofs[i].actuated && limits.isPlain(i))
      look(i, model.jointNames[model.dofs[i].body],
           model.bodies[model.dofs[i].body].joint == JointKind::prismatic ? " N" : " N m");
  if (limits.transmission) {
    const auto& actuators = limits.transmission->actuators();
    for (int k = 0; k < static_cast<int>(actuators.size()); ++k)
      look(limits.transmission->coordinateOf(k), actuators[static_cast<std::size_t>(k)].name, "");
  }
  if (weak.empty()) return {};
  return {
      fmt::format("cannot hold the start against gravity: {}; try another start, or efforts as "
                  "the robot has them",
                  listed(weak))};
}

}  // namespace

std::vector<std::string> startWarnings(const Model& model, const State& state,
                                       const gdd::GoalDirectedController& controller, Data& data) {
  if (controller.goals.empty()) return {};
  std::vector<std::string> warnings = weakAtStart(model, state, controller, data);
  for (std::string& text : inDegrees(model, controller)) warnings.push_back(std::move(text));
  return warnings;
}

}  // namespace softgauss::app

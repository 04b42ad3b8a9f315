// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/start_check.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apps/simulate_gdd/names.hpp"
#include "softgauss/gdd/gravity_compensation.hpp"

namespace softgauss::app {
namespace {

constexpr double kTold = 1.01;  // of the limit

}  // namespace

std::vector<std::string> weakAtStart(const Model& model, const State& state,
                                     const gdd::GoalDirectedController& controller, Data& data) {
  if (controller.goals.empty()) return {};
  const gdd::ControlLimits& limits = controller.limits;
  gdd::GravityCompensation holding;
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

}  // namespace softgauss::app

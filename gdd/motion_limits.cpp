// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/motion_limits.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::gdd {
namespace {

constexpr double kBegins = 0.5;    // of the speed that is allowed
constexpr double kOwnShare = 0.5;  // of a motor's effort, to brake with

bool isDriven(const Model& model, const ControlLimits& limits, int dof) {
  return model.dofs[dof].actuated || (limits.transmission && limits.transmission->pulls(dof));
}

/// 1/M_ii.
double inverseOf(const Data& data, int dof) {
  return data.inertia.motionScale[dof] * data.inertia.motionScale[dof];
}

/// What may come to the joint's speed within a step: by its own motor, or by as much acceleration
/// as in the last step [rad/s or m/s].
double gain(const GoalContext& context, const ControlLimits& limits, int dof) {
  const Dof& d = context.model.dofs[dof];
  if (!d.actuated || (limits.transmission && limits.transmission->pulls(dof))) return kInfinity;
  const double inverseInertia =
      std::max(inverseOf(context.data, dof), context.data.weights.dof[dof]);
  const double own = std::max(d.effortUpper, -d.effortLower) * inverseInertia;
  const WarmStart& last = context.state.warmstart;
  const double before = last.gddValid ? std::abs(last.gddA[dof]) : 0.0;
  return context.model.options.timestep * std::max(own, before);
}

/// â: what the joint brakes by, ahead of an end of its range [rad/s² or m/s²].
double braking(const GoalContext& context, const ControlLimits& limits, int dof, double arrival) {
  const Dof& d = context.model.dofs[dof];
  const double most = arrival / context.model.options.timestep;
  if (!d.actuated || (limits.transmission && limits.transmission->pulls(dof))) return most;
  const double effort = std::min(d.effortUpper, -d.effortLower);
  return std::min(most, kOwnShare * effort * inverseOf(context.data, dof));
}

}  // namespace

void MotionLimits::addCost(const GoalContext& context, const ControlLimits& limits,
                           GoalCost& cost) const {
  const Model& model = context.model;
  // sign 1: upwards, with `room` [rad or m] to the upper end of the range; −1: downwards.
  const auto bound = [&](int dof, double sign, double room, double gained) {
    double allowed = model.dofs[dof].velocityLimit, falls = 0.0;  // −u̇ for a joint at u
    if (room < kInfinity) {
      const double brake = braking(context, limits, dof, arrivalSpeed);
      const double near = std::sqrt(2.0 * brake * std::max(0.0, room));
      if (near < allowed && near > arrivalSpeed) falls = brake;
      allowed = std::min(allowed, std::max(arrivalSpeed, near));
    }
    const double speed = sign * context.state.v[dof];
    if (!(speed + gained > kBegins * allowed)) return;
    const double time = std::max(brakingTime, context.model.options.timestep);
    cost.addOneSided(dof, -sign, weight * context.data.inertia.M.row(dof)[dof],
                     (speed - allowed) / time + falls * std::max(0.0, speed) / allowed);
  };
  auto range = model.ranges.begin();
  const auto boundAll = [&](int dof) {
    const int body = model.dofs[dof].body;
    if (model.bodies[body].dofs != 1 || !isDriven(model, limits, dof)) return;
    while (range != model.ranges.end() && range->body < body) ++range;
    const bool ranged = range != model.ranges.end() && range->body == body;
    const double q = context.state.q[model.bodies[body].q];
    const double gained = gain(context, limits, dof);
    bound(dof, 1.0, ranged ? range->upper - q : kInfinity, gained);
    bound(dof, -1.0, ranged ? q - range->lower : kInfinity, gained);
  };
  for (const Segment s : context.data.active.dofs())
    for (int dof = s.begin; dof < s.end; ++dof) boundAll(dof);
}

}  // namespace softgauss::gdd

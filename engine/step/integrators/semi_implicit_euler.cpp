// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/semi_implicit_euler.hpp"

#include <algorithm>

#include "engine/step/forward.hpp"

namespace softgauss {
namespace {

/// A body turns by more than 0.005 rad in the step, or a tree was followed in the last one. Below
/// that (T.93) need not be worked out.
bool mayTurnFar(const Model& model, const Data& data, State& state) {
  if (std::find(state.followed.begin(), state.followed.end(), 1) != state.followed.end())
    return true;
  const double fast = 0.005 / model.options.timestep;
  for (const Motion& V : data.kinematics.V)
    if (V.angular.squaredNorm() > fast * fast) return true;
  std::fill(state.followed.begin(), state.followed.end(), std::uint8_t{0});
  return false;
}

}  // namespace

bool semiImplicitEuler(const Model& model, Data& data, State& state) {
  const double h = model.options.timestep;
  ForwardSolution& s = data.forward;
  const Plan& plan = data.plan;
  const bool damped = plan.damped(), midpoint = plan.midpoint;
  data.acceleration = s.a;
  bool follow = false;
  if (damped || midpoint) {
    // Right side M a, less what the Coriolis forces gain by mid-step.
    VectorX& net = data.acceleration;
    if (data.constraints.active().empty())
      net = s.Ma;
    else
      data.inertia.M.multiply(s.a, net);
    if (midpoint) {
      s.start = state.v + 0.5 * h * s.a;
      ++data.forces.calls.coriolis;
      computeBiasAt(model, data.kinematics, data.inertia, s.start, data.forces.work, s.direction);
      s.direction -= data.forces.bias;
      net -= s.direction;
    }
    if (damped) s.Md = h * plan.damping;
    if (!solveMass(data, damped ? &s.Md : nullptr, net)) return false;
    if (midpoint && mayTurnFar(model, data, state)) {
      // What Δb does to the velocity, damped like the rest.
      if (!damped)
        s.direction = s.a - net;
      else if (plan.diagonal)
        solveMass(data, &s.Md, s.direction);
      else
        s.massFactor.solve(s.direction);
      follow = data.followed.needed(model, data, state, s.direction);
    }
  }
  s.start = state.v + h * data.acceleration;
  if (!s.start.allFinite()) return false;
  if (follow) {
    data.followed.follow(model, data, state, s.direction, s.start);
    if (!s.start.allFinite()) return false;
    data.acceleration = (s.start - state.v) / h;
  }
  state.v = s.start;
  integratePosition(model, state.v, h, state.q);
  if (follow) data.followed.copyPositions(model, state.q);
  state.time += h;
  return true;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/semi_implicit_euler.hpp"

#include "engine/step/forward.hpp"

namespace softgauss {

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
    if (midpoint) {
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

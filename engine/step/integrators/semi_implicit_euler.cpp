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
      net -= s.direction - data.forces.bias;
    }
    if (damped) s.direction = h * plan.damping;
    if (!solveMass(data, damped ? &s.direction : nullptr, net)) return false;
  }
  s.start = state.v + h * data.acceleration;
  if (!s.start.allFinite()) return false;
  state.v = s.start;
  integratePosition(model, state.v, h, state.q);
  state.time += h;
  return true;
}

}  // namespace softgauss

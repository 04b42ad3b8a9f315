// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/semi_implicit_euler.hpp"

#include "engine/forces/damping.hpp"

namespace softgauss {

bool semiImplicitEuler(const Model& model, Data& data, State& state) {
  const double h = model.options.timestep;
  ForwardSolution& s = data.forward;
  const bool damped = hasDamping(model);
  const bool midpoint =
      model.options.midpointCoriolis && model.options.effects.has(Effect::coriolis);
  data.acceleration = s.a;
  if (damped || midpoint) {
    // Right side M a, less what the Coriolis forces gain by mid-step.
    data.inertia.M.multiply(s.a, s.Md);
    if (midpoint) {
      s.start = state.v + 0.5 * h * s.a;
      computeBiasAt(model, data.kinematics, data.inertia, s.start, data.forces.work, s.direction);
      s.Md -= s.direction - data.forces.bias;
    }
    for (int i = 0; i < model.nv; ++i) s.direction[i] = damped ? h * model.dofs[i].damping : 0.0;
    if (!s.massFactor.compute(data.inertia.M, s.direction.data())) return false;
    data.acceleration = s.Md;
    s.massFactor.solve(data.acceleration);
  }
  s.start = state.v + h * data.acceleration;
  if (!s.start.allFinite()) return false;
  state.v = s.start;
  integratePosition(model, state.v, h, state.q);
  state.time += h;
  return true;
}

}  // namespace softgauss

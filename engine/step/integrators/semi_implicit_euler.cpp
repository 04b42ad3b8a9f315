// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/semi_implicit_euler.hpp"

#include "engine/forces/damping.hpp"

namespace softgauss {

bool semiImplicitEuler(const Model& model, Data& data, State& state) {
  const double h = model.options.timestep;
  ForwardSolution& s = data.forward;
  data.acceleration = s.a;
  if (hasDamping(model)) {
    for (int i = 0; i < model.nv; ++i) s.direction[i] = h * model.dofs[i].damping;
    if (!s.massFactor.compute(data.inertia.M, s.direction.data())) return false;
    data.inertia.M.multiply(s.a, s.Md);
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

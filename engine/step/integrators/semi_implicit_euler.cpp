// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/semi_implicit_euler.hpp"

#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/integrators/implicit_forces.hpp"
#include "softgauss/engine/step/integrators/kick.hpp"

namespace softgauss {

bool semiImplicitEuler(const Model& model, Data& data, State& state) {
  const double h = model.options.timestep;
  ForwardSolution& s = data.forward;
  data.acceleration = s.a;
  if (implicitFollows(model, data)) {
    VectorX& net = data.acceleration;  // M a
    if (data.constraints.active().empty())
      net = data.forces.net;
    else
      data.bodies.multiplyMass(model, data.kinematics, data.inertia, s.a, net);
    setImplicitForces(model, state, data, net);
    if (!solveMass(model, data, &s.diagonal, net)) return false;
  }
  s.start = state.v + h * data.acceleration;
  if (tooFast(model, data.active, s.start)) return false;
  state.v = s.start;
  integratePosition(model, state.v, h, data.active.bodies(), state.q);
  keepConnectionForces(model, data, state);
  state.time += h;
  return true;
}

}  // namespace softgauss

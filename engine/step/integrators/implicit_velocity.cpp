// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/implicit_velocity.hpp"

#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/integrators/implicit_forces.hpp"
#include "softgauss/engine/step/integrators/kick.hpp"
#include "softgauss/engine/step/integrators/velocity_derivative.hpp"

namespace softgauss {

bool implicitVelocity(const Model& model, Data& data, State& state) {
  const double h = model.options.timestep;
  ForwardSolution& s = data.forward;
  VectorX& net = data.acceleration;
  if (data.constraints.active().empty())
    net = data.forces.net;
  else
    data.bodies.multiplyMass(model, data.kinematics, data.inertia, s.a, net);
  const bool diagonal = data.plan.hasDamping() || anyStiffSpring(model, data);
  if (diagonal) setImplicitForces(model, state, data, net);
  const VectorX* added = diagonal ? &s.diagonal : nullptr;
  if (data.plan.coriolis && data.derivative->factorize(model, data, h, added))
    data.derivative->solve(model, net);
  else if (!solveMass(model, data, added, net))
    return false;
  s.start = state.v + h * data.acceleration;
  if (tooFast(model, data.active, s.start)) return false;
  state.v = s.start;
  integratePosition(model, state.v, h, state.q);
  state.time += h;
  return true;
}

}  // namespace softgauss

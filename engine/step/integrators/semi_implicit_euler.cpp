// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/semi_implicit_euler.hpp"

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/integrators/implicit_forces.hpp"
#include "softgauss/engine/step/integrators/kick.hpp"

namespace softgauss {

bool semiImplicitEuler(const Model& model, Data& data, State& state) {
  const double h = model.options.timestep;
  const Segments dofs = data.active.dofs();
  ForwardSolution& s = data.forward;
  copy(dofs, s.a, data.acceleration);
  if (implicitFollows(model, data)) {
    VectorX& net = data.acceleration;  // M a
    if (data.constraints.active().empty())
      copy(dofs, data.forces.net, net);
    else
      data.bodies.multiplyMass(model, data.kinematics, data.inertia, s.a, net);
    setImplicitForces(model, state, data, net);
    if (!solveMass(model, data, &s.diagonal, net)) return false;
  }
  for (const Segment of : dofs)
    part(s.start, of) = part(state.v, of) + h * part(data.acceleration, of);
  if (tooFast(model, data.active, s.start)) return false;
  copy(dofs, s.start, state.v);
  integratePosition(model, state.v, h, data.active.bodies(), state.q);
  keepConnectionForces(model, data, state);
  state.time += h;
  return true;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/implicit_forces.hpp"

#include <algorithm>

namespace softgauss {

bool isStiffSpring(const Model& model, const Data& data, const Plan::Spring& spring) {
  const double h = model.options.timestep;
  return model.options.midpointCoriolis &&
         h * h * spring.stiffness * data.weights.dof[spring.dof] > 1.0;
}

bool anyStiffSpring(const Model& model, const Data& data) {
  const std::vector<Plan::Spring>& springs = data.plan.springs;
  return std::any_of(springs.begin(), springs.end(), [&](const Plan::Spring& spring) {
    return isStiffSpring(model, data, spring);
  });
}

void setImplicitForces(const Model& model, const State& state, Data& data, VectorX& net) {
  const double h = model.options.timestep;
  VectorX& Md = data.forward.Md;
  if (data.plan.damped())
    Md = h * data.plan.damping;
  else
    Md.setZero();
  for (const Plan::Spring& spring : data.plan.springs) {
    if (!isStiffSpring(model, data, spring)) continue;
    Md[spring.dof] += h * h * spring.stiffness;
    net[spring.dof] -= h * spring.stiffness * state.v[spring.dof];
  }
}

}  // namespace softgauss

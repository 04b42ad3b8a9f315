// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/implicit_forces.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/segment_vectors.hpp"

namespace softgauss {

bool isStiffSpring(const Model& model, const Data& data, const Plan::Spring& spring) {
  const Options& o = model.options;
  const double h = o.rowTimestep();
  return o.implicitInSolve && h * h * spring.stiffness * data.weights.dof[spring.dof] > 1.0;
}

bool anyStiffSpring(const Model& model, const Data& data) {
  const std::vector<Plan::Spring>& springs = data.plan.springs;
  return std::any_of(springs.begin(), springs.end(), [&](const Plan::Spring& spring) {
    return isStiffSpring(model, data, spring);
  });
}

bool implicitFollows(const Model& model, const Data& data) {
  return !data.plan.inSolve && (data.plan.hasDamping() || anyStiffSpring(model, data));
}

void addImplicitForces(const Model& model, const State& state, Data& data) {
  for (const Plan::Spring& spring : data.plan.springs) {
    if (!isStiffSpring(model, data, spring)) continue;
    if (!data.active.holds(model, model.dofs[idx(spring.dof)].body)) continue;
    const double ahead = model.options.timestep * spring.stiffness * state.v[spring.dof];
    data.forces.c[spring.dof] += ahead;
    data.forces.net[spring.dof] -= ahead;
  }
}

void addImplicitInertia(const Model& model, Data& data) {
  const double h = model.options.timestep;
  MassMatrix& inertia = data.inertia;
  const Segments dofs = data.active.dofs();
  if (data.plan.hasDamping())
    for (const Segment s : dofs) part(inertia.added, s) += h * part(data.plan.damping, s);
  for (const Plan::Spring& spring : data.plan.springs)
    if (isStiffSpring(model, data, spring) &&
        data.active.holds(model, model.dofs[idx(spring.dof)].body))
      inertia.added[spring.dof] += h * h * spring.stiffness;
  inertia.anyAdded = std::ranges::any_of(
      dofs, [&](Segment s) { return (part(inertia.added, s).array() != 0.0).any(); });
  if (!inertia.anyAdded) return;
  if (inertia.whole) inertia.Mhat.assign(inertia.M, dofs);
  for (const Segment s : dofs)
    for (int i = s.begin; i < s.end; ++i) {
      double& pivot = inertia.Mhat.row(i)[i];
      pivot = inertia.M.row(i)[i] + inertia.added[i];
      inertia.forceScale[i] = 1.0 / std::sqrt(pivot);
    }
}

void setImplicitForces(const Model& model, const State& state, Data& data, VectorX& net) {
  const double h = model.options.timestep;
  VectorX& added = data.forward.diagonal;
  if (data.plan.hasDamping())
    added = h * data.plan.damping;
  else
    added.setZero();
  for (const Plan::Spring& spring : data.plan.springs) {
    if (!isStiffSpring(model, data, spring)) continue;
    added[spring.dof] += h * h * spring.stiffness;
    net[spring.dof] -= h * spring.stiffness * state.v[spring.dof];
  }
}

}  // namespace softgauss

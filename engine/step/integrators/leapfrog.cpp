// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/leapfrog.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/step/integrators/implicit_forces.hpp"
#include "softgauss/engine/step/integrators/kick.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {
namespace {

/// By which a joint may end elsewhere than was predicted [rad].
constexpr double kForgets = 1e-3;

/// Sets the velocity of joints on stiff springs to `share` of it.
void scaleStiff(const Model& model, const Data& data, double share, VectorX& v) {
  for (const Plan::Spring& spring : data.plan.springs)
    if (isStiffSpring(model, data, spring)) v[spring.dof] *= share;
}

double worstTurn(const Model& model, const Tree& tree, const VectorX& a, const VectorX& predicted) {
  double worst = 0.0;
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[b];
    if (body.joint == JointKind::prismatic) continue;
    const int first = body.joint == JointKind::floating ? body.v + 3 : body.v;
    for (int i = first; i < body.v + body.dofs; ++i)
      worst = std::max(worst, std::abs(a[i] - predicted[i]));
  }
  return worst;
}

}  // namespace

void driftBefore(const Model& model, Data& data, State& state) {
  VectorX& v = data.forward.direction;
  copy(data.active.dofs(), state.v, v);
  scaleStiff(model, data, 0.0, v);
  integratePosition(model, v, 0.5 * model.options.timestep, data.active.bodies(), state.q);
}

bool predictsMidstepVelocity(const Model& model, const State& state) {
  return state.hasAcceleration && model.options.uses(Mechanism::midpointVelocity);
}

void predictMidstepVelocity(const Model& model, const State& state, Data& data) {
  if (!predictsMidstepVelocity(model, state)) return;
  for (const Segment s : data.active.dofs())
    part(data.midstepVelocity, s) =
        part(state.v, s) + 0.5 * model.options.timestep * part(state.a, s);
  setMidstepVelocity(model, data.midstepVelocity, data.active.bodies(), data.kinematics);
}

bool predictionFailed(const Model& model, Data& data, State& state) {
  if (!data.plan.coriolis || !model.options.uses(Mechanism::midpointVelocity)) return false;
  const double h = model.options.timestep;
  const VectorX& a = data.forward.a;
  std::vector<std::uint8_t>& mispredicted = data.parts->mispredicted;
  std::fill(mispredicted.begin(), mispredicted.end(), 0);
  bool any = false;
  for (const int of : data.active.trees()) {
    const std::size_t t = idx(of);
    const Tree& tree = model.trees[t];
    if (data.parts->leaves(tree.rootBody)) continue;
    // A joint alone has nothing to turn against.
    if (data.parts->substepSelection.free[t] || tree.dofEnd - tree.firstDof == 1) continue;
    const double off = 0.5 * h * h * worstTurn(model, tree, a, state.a);
    if (state.hasAcceleration && !(off > kForgets)) continue;
    const int first = tree.firstDof, dofs = tree.dofEnd - first;
    state.a.segment(first, dofs) = a.segment(first, dofs);
    mispredicted[t] = 1, any = true;
  }
  if (any) keepConnectionForces(model, data, state, mispredicted);
  state.hasAcceleration = state.hasAcceleration || any;
  return any;
}

bool kickAndDrift(const Model& model, Data& data, State& state) {
  const double h = model.options.timestep;
  const Segments dofs = data.active.dofs();
  VectorX& v = data.forward.start;
  copy(dofs, data.forward.a, data.acceleration);
  for (const Segment s : dofs) part(v, s) = part(state.v, s) + h * part(data.acceleration, s);
  if (tooFast(model, data.active, v)) return false;
  copy(dofs, v, state.v);
  scaleStiff(model, data, 2.0, v);
  integratePosition(model, v, 0.5 * h, data.active.bodies(), state.q);
  copy(dofs, data.acceleration, state.a);
  state.hasAcceleration = true;
  keepConnectionForces(model, data, state);
  state.time += h;
  return true;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/forces/forces.hpp"

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/forces/damping.hpp"
#include "softgauss/engine/forces/external_wrench.hpp"
#include "softgauss/engine/forces/gravity_compensation.hpp"
#include "softgauss/engine/forces/spring.hpp"

namespace softgauss {

void computeSmoothForces(const Model& model, const Plan& plan, const State& state,
                         const Input& input, const Kinematics& k, const MassMatrix& inertia,
                         const TreeSelection& trees, SmoothForces& stage) {
  SmoothForces::Calls& calls = stage.calls;
  if (plan.gravity || plan.coriolis) {  // else the bias stays zero
    calls.gravity += plan.gravity;
    calls.coriolis += plan.coriolis;
    computeBias(model, k, inertia, trees.bodies(), stage.work, stage.bias);
  }
  const Segments dofs = trees.dofs();
  copy(dofs, stage.bias, stage.c);
  if (plan.bearsWeight) addGravityCompensation(model, k, trees, stage.c);
  if (plan.hasDamping()) {
    ++calls.damping;
    addDamping(dofs, plan.damping, state.v, stage.c);
  }
  if (plan.hasSprings()) {
    ++calls.spring;
    addSprings(model, plan.springs, state.q, trees, stage.c);
  }
  if (plan.hasExternalWrench()) {
    setZero(dofs, stage.push);
    for (const ExternalWrench& wrench : input.wrenches) {
      if (!trees.holds(model, wrench.body)) continue;
      ++calls.externalWrench;
      addExternalWrench(model, k, wrench, stage.push);
    }
    for (const Segment s : dofs) part(stage.c, s) -= part(stage.push, s);
  }
  if (input.tau.size() == model.nv)
    copy(dofs, input.tau, stage.tau);
  else
    setZero(dofs, stage.tau);
  for (const Segment s : dofs) part(stage.net, s) = part(stage.tau, s) - part(stage.c, s);
}

void setAppliedForce(const VectorX& tau, SmoothForces& stage) {
  stage.tau = tau;
  stage.net = tau - stage.c;
}

void setAppliedForce(Segments dofs, const VectorX& tau, SmoothForces& stage) {
  copy(dofs, tau, stage.tau);
  for (const Segment s : dofs) part(stage.net, s) = part(tau, s) - part(stage.c, s);
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/forces/forces.hpp"

#include "softgauss/engine/forces/damping.hpp"
#include "softgauss/engine/forces/external_wrench.hpp"
#include "softgauss/engine/forces/spring.hpp"

namespace softgauss {

void computeSmoothForces(const Model& model, const Plan& plan, const State& state,
                         const Input& input, const Kinematics& k, const MassMatrix& inertia,
                         Segments bodies, SmoothForces& stage) {
  SmoothForces::Calls& calls = stage.calls;
  if (plan.gravity || plan.coriolis) {  // else the bias stays zero
    calls.gravity += plan.gravity;
    calls.coriolis += plan.coriolis;
    computeBias(model, k, inertia, bodies, stage.work, stage.bias);
  }
  stage.c = stage.bias;
  if (plan.hasDamping()) {
    ++calls.damping;
    addDamping(plan.damping, state.v, stage.c);
  }
  if (plan.hasSprings()) {
    ++calls.spring;
    addSprings(plan.springs, state.q, stage.c);
  }
  if (plan.hasExternalWrench()) {
    stage.push.setZero();
    for (const ExternalWrench& wrench : input.wrenches) {
      ++calls.externalWrench;
      addExternalWrench(model, k, wrench, stage.push);
    }
    stage.c -= stage.push;
  }
  if (input.tau.size() == model.nv)
    stage.tau = input.tau;
  else
    stage.tau.setZero();
  stage.net = stage.tau - stage.c;
}

void setAppliedForce(const VectorX& tau, SmoothForces& stage) {
  stage.tau = tau;
  stage.net = tau - stage.c;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "engine/forces/forces.hpp"

#include "engine/forces/damping.hpp"
#include "engine/forces/external_wrench.hpp"
#include "engine/forces/spring.hpp"

namespace softgauss {

void computeSmoothForces(const Model& model, const State& state, const Input& input,
                         const Kinematics& k, const MassMatrix& inertia, SmoothForces& stage) {
  computeBias(model, k, inertia, stage.work, stage.bias);
  stage.c = stage.bias;
  addDamping(model, state.v, stage.c);
  addSprings(model, state.q, stage.c);
  if (model.options.effects.has(Effect::externalWrench))
    for (const ExternalWrench& wrench : input.wrenches)
      addExternalWrench(model, k, wrench, stage.c);
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

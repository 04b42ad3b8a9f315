// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/inverse.hpp"

namespace softgauss {

void inverseDynamics(const Model&, const VectorX& a, Data& data, VectorX& tau) {
  bool changed = false;
  data.constraints.setResidual(a);
  data.constraints.evaluate(changed);
  // −τ = −M a − c + Jᵀf, as addForce() adds.
  VectorX& Ma = data.forward.Md;
  data.inertia.hat().multiply(a, Ma);
  tau = -Ma - data.forces.c;
  data.constraints.addForce(tau);
  tau = -tau;
}

void inverseDynamicsJacobian(Data& data, TreeMatrix& P) {
  P.resize(data.constraints.sparsity());
  P.assign(data.inertia.hat());
  data.constraints.addCurvature(P);
}

}  // namespace softgauss

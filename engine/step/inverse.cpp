// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/inverse.hpp"

namespace softgauss {

SolveStatus inverseDynamics(const Model& model, const VectorX& a, Data& data, VectorX& tau) {
  if (a.size() != model.nv) {
    data.stats.refuse(
        model, {BadInputKind::a, -1, static_cast<double>(a.size()), static_cast<double>(model.nv)});
    return data.stats.status;
  }
  if (!a.allFinite()) return data.stats.status = SolveStatus::notFinite;
  bool changed = false;
  data.constraints.setResidual(a);
  data.constraints.evaluate(changed);
  // −τ = −M a − c + Jᵀf, as addForce() adds.
  VectorX& Ma = data.forward.Md;
  data.inertia.hat().multiply(a, Ma);
  tau = -Ma - data.forces.c;
  data.constraints.addForce(tau);
  tau = -tau;
  return SolveStatus::converged;
}

void inverseDynamicsJacobian(Data& data, TreeMatrix& P) {
  P.resize(data.constraints.sparsity());
  P.assign(data.inertia.hat());
  data.constraints.addCurvature(P);
}

}  // namespace softgauss

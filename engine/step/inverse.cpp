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
  BodySolution& s = data.bodies;
  s.moveTo(model, data.kinematics, data.inertia, a);
  data.constraints.setResidual(BodyMotion{a, s.A});
  data.constraints.evaluate(changed);
  // −τ = −c − M a + Jᵀf
  tau = -data.forces.c;
  s.addForces(model, data.kinematics, data.constraints, a, tau);
  tau = -tau;
  return SolveStatus::converged;
}

bool inverseDynamicsJacobian(Data& data, TreeMatrix& P) {
  if (!data.inertia.whole || data.constraints.columnsComeLater()) return false;
  P.resize(data.constraints.sparsity());
  P.assign(data.inertia.hat());
  data.constraints.addCurvature(P);
  return true;
}

}  // namespace softgauss

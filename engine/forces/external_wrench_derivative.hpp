// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A wrench that is constant in world axes acts at the body's origin, which q moves:
///   ∂(−S_i·F_O)/∂q_j = −S_i·(t_j × f, 0) − (S_j × S_i)·F_O,   t_j the motion of the origin (D.3)
/// the second term where j moves S_i.

#include "softgauss/engine/dynamics/jacobian.hpp"
#include "softgauss/engine/dynamics/motion_derivative.hpp"

namespace softgauss {

/// Gq ← Gq + the derivative of what addExternalWrench() adds to c.
inline void addExternalWrenchDerivative(const Model& model, const Kinematics& k,
                                        const ExternalWrench& wrench, MatrixX& Gq) {
  const Body& body = model.bodies[idx(wrench.body)];
  if (body.dofs == 0) return;
  const Vector3 r = k.X_WB[idx(wrench.body)].p - k.p_WO[idx(body.tree)];
  const Force& F = wrench.F_Bo_W;
  const Force F_O{F.moment + r.cross(F.force), F.force};
  for (int j = model.lastDof(wrench.body); j >= 0; j = model.dofs[idx(j)].parent) {
    const Motion& S = k.S[idx(j)];
    const Force moved{dofPointVelocity(S, r).cross(F.force), Vector3::Zero()};
    const Force carried = moved - crossForce(S, F_O);
    for (int i = model.lastDof(wrench.body); i >= 0; i = model.dofs[idx(i)].parent)
      Gq(i, j) -= dot(k.S[idx(i)], movesAxis(model, j, i) ? carried : moved);
  }
}

}  // namespace softgauss

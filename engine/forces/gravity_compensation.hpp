// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Weight that is borne: a force −m g at the centre of a mass m of a body, which c gains as
///   −Σ J_Cᵀ (−m g)
/// where gravity acts. What bears it is outside of the system, as a motor is: its work is no energy
/// of the model. m may be less than the body's mass, or more, as of what floats up. Its
/// derivative is that of a wrench of constant force at C (D.3).

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/dynamics/jacobian.hpp"
#include "softgauss/engine/dynamics/motion_derivative.hpp"
#include "softgauss/engine/dynamics/tree_selection.hpp"

namespace softgauss {

/// The place C from the tree's reference point, and −m g, of a body that has a mass borne.
struct BorneWeight {
  BorneWeight(const Model& model, const Kinematics& k, int b)
      : r(k.X_WB[idx(b)] * model.bodies[idx(b)].borneCom - k.p_WO[idx(model.bodies[idx(b)].tree)]),
        force(-model.bodies[idx(b)].borneMass * model.options.gravity) {}
  Force about() const { return {r.cross(force), force}; }

  Vector3 r, force;
};

/// c ← c − Jᵀ F of all bodies of these trees.
inline void addGravityCompensation(const Model& model, const Kinematics& k,
                                   const TreeSelection& trees, VectorX& c) {
  for (int b = 1; b < model.bodyCount(); ++b) {
    if (model.bodies[idx(b)].borneMass == 0.0 || !trees.holds(model, b)) continue;
    const Force F = BorneWeight(model, k, b).about();
    for (int i = model.lastDof(b); i >= 0; i = model.dofs[idx(i)].parent)
      c[i] -= dot(k.S[idx(i)], F);
  }
}

/// Gq ← Gq + the derivative of that.
inline void addGravityCompensationDerivative(const Model& model, const Kinematics& k, MatrixX& Gq) {
  for (int b = 1; b < model.bodyCount(); ++b) {
    if (model.bodies[idx(b)].borneMass == 0.0) continue;
    const BorneWeight weight(model, k, b);
    const Force F = weight.about();
    for (int j = model.lastDof(b); j >= 0; j = model.dofs[idx(j)].parent) {
      const Motion& S = k.S[idx(j)];
      const Force moved{dofPointVelocity(S, weight.r).cross(weight.force), Vector3::Zero()};
      const Force carried = moved - crossForce(S, F);
      for (int i = model.lastDof(b); i >= 0; i = model.dofs[idx(i)].parent)
        Gq(i, j) -= dot(k.S[idx(i)], movesAxis(model, j, i) ? carried : moved);
    }
  }
}

}  // namespace softgauss

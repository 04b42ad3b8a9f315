// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A wrench F applied to a body adds Jᵀ F to the generalised force.

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss {

inline void addExternalWrench(const Model& model, const Kinematics& k, const ExternalWrench& wrench,
                              VectorX& push) {
  const Body& body = model.bodies[idx(wrench.body)];
  if (body.dofs == 0) return;
  // Moved from the body's origin to the tree's reference point O.
  const Vector3 r = k.X_WB[idx(wrench.body)].p - k.p_WO[idx(body.tree)];
  const Force F_O{wrench.F_Bo_W.moment + r.cross(wrench.F_Bo_W.force), wrench.F_Bo_W.force};
  for (int i = model.lastDof(wrench.body); i >= 0; i = model.dofs[idx(i)].parent)
    push[i] += dot(k.S[idx(i)], F_O);
}

}  // namespace softgauss

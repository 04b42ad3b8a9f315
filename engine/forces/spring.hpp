// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Joint springs: force −k (q − q_s) on each scalar joint that has a stiffness k, so c gains
/// k (q − q_s) (T.31). The step takes it explicitly, as MuJoCo's does: h √(k/m) < 2 is needed, m
/// being the inertia that the joint moves.

#include "engine/model/state.hpp"

namespace softgauss {

inline void addSprings(const Model& model, const VectorX& q, VectorX& c) {
  if (!model.options.effects.has(Effect::spring)) return;
  for (int i = 0; i < model.nv; ++i) {
    const Dof& dof = model.dofs[i];
    if (dof.stiffness != 0.0)
      c[i] += dof.stiffness * (q[model.bodies[dof.body].q] - dof.springReference);
  }
}

}  // namespace softgauss

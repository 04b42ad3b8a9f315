// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Joint springs: force −k (q − q_s) on each scalar joint that has a stiffness k, so c gains
/// k (q − q_s) (2.5). The step takes it explicitly, as MuJoCo's does: h √(k/m) < 2 is needed, m
/// being the inertia that the joint moves.

#include <vector>

#include "softgauss/engine/dynamics/tree_selection.hpp"
#include "softgauss/engine/model/plan.hpp"

namespace softgauss {

/// Those of these trees.
inline void addSprings(const Model& model, const std::vector<Plan::Spring>& springs,
                       const VectorX& q, const TreeSelection& trees, VectorX& c) {
  for (const Plan::Spring& s : springs)
    if (trees.holds(model, model.dofs[idx(s.dof)].body))
      c[s.dof] += s.stiffness * (q[s.q] - s.reference);
}

}  // namespace softgauss

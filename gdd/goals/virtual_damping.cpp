// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/virtual_damping.hpp"

#include <cmath>

namespace softgauss::gdd {

void VirtualDamping::addCost(const GoalContext& context, GoalCost& cost) const {
  const TreeMatrix& M = context.data.inertia.M;
  const VectorX& v = context.state.v;
  if (metric == DampingMetric::inertia) return cost.addMetric(weight, M, -rate * v);
  // M⁻¹ = L⁻¹D⁻¹L⁻ᵀ with M = LᵀDL: a sum of squares of rows e_kᵀD^−½L⁻ᵀ.
  GoalWorkspace& work = cost.workspace();
  TreeFactor& factor = work.massFactor;
  if (!factor.compute(M)) return;  // the solver reports it
  for (int k = 0; k < factor.size(); ++k) {
    work.dofs.setZero();
    work.dofs[k] = std::sqrt(factor.inversePivot(k));
    factor.solveLower(work.dofs);
    const Eigen::Matrix<double, 1, 1> wished(-rate * work.dofs.dot(v));
    work.rows.row(0) = work.dofs.transpose();
    cost.addRows(work.rows.topRows(1), weight, wished);
  }
}

}  // namespace softgauss::gdd

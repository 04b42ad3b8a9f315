// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/functions.hpp"

#include "softgauss/gdd/next_state.hpp"

namespace softgauss::gdd {

void FunctionGoal::addCost(const GoalContext& context, GoalCost& cost) const {
  cost.addFunction([this, context](const VectorX& a, VectorX& gradient, MatrixX& hessian) {
    return function(context, a, gradient, hessian);
  });
}

void ValueGoal::addCost(const GoalContext& context, GoalCost& cost) const {
  const Eigen::Index n = context.model.nv;
  cost.addFunction([this, n, next = NextState(context), slope = VectorX(2 * n),
                    curvature = MatrixX(2 * n, 2 * n)](const VectorX& a, VectorX& gradient,
                                                       MatrixX& hessian) mutable {
    next.set(a);
    const double V = value(next.q(), next.v(), slope, curvature);
    gradient = weight * next.pulledBack(slope);
    hessian = weight * next.pulledBack(curvature);
    return weight * V;
  });
}

}  // namespace softgauss::gdd

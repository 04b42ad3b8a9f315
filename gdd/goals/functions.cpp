// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/functions.hpp"

namespace softgauss::gdd {

void FunctionGoal::addCost(const GoalContext& context, GoalCost& cost) const {
  cost.addFunction([this, context](const VectorX& a, VectorX& gradient, MatrixX& hessian) {
    return function(context, a, gradient, hessian);
  });
}

void ValueGoal::addCost(const GoalContext& context, GoalCost& cost) const {
  const double h = context.model.options.timestep;
  VectorX next = context.state.q;
  integratePosition(context.model, context.state.v, h, next);
  cost.addFunction(
      [this, h, next, v = context.state.v](const VectorX& a, VectorX& gradient, MatrixX& hessian) {
        const double V = value(next, v + h * a, gradient, hessian);
        gradient *= weight * h;
        hessian *= weight * h * h;
        return weight * V;
      });
}

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/joint_velocity.hpp"

namespace softgauss::gdd {

void JointVelocity::addCost(const GoalContext& context, GoalCost& cost) const {
  for (const JointTarget& target : targets) {
    const int dof = context.model.bodies[target.body].v;
    cost.addDof(dof, weight * context.data.inertia.M.row(dof)[dof],
                rate * (target.value - context.state.v[dof]));
  }
}

}  // namespace softgauss::gdd

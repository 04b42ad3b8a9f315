// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/joints.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::gdd {

JointTarget jointTarget(const Model& model, const std::string& joint, double value) {
  const std::string element = "goal of joint '" + joint + "'";
  const int body = model.findJoint(joint);
  if (body < 0) throw ModelError({}, element, "the model has no joint of that name");
  const int dofs = model.bodies[body].dofs;
  if (dofs != 1)
    throw ModelError({}, element,
                     "has " + std::to_string(dofs) + " degrees of freedom, expected one");
  if (!std::isfinite(value)) throw ModelError({}, element, "the target is not finite");
  return {body, value};
}

void JointAcceleration::addCost(const GoalContext& context, GoalCost& cost) const {
  for (const JointTarget& target : targets) {
    const int dof = context.model.bodies[target.body].v;
    cost.addDof(dof, weight * context.data.inertia.M.row(dof)[dof], target.value);
  }
}

void JointPosture::addCost(const GoalContext& context, GoalCost& cost) const {
  for (const JointTarget& target : targets) {
    const Body& body = context.model.bodies[target.body];
    const CoordinateMotion to = target.positionAt(context.state.time);
    cost.addDof(body.v, weight * context.data.inertia.M.row(body.v)[body.v],
                to.a + stiffness * (to.p - context.state.q[body.q]) +
                    damping * (to.v - context.state.v[body.v]));
  }
}

bool JointPosture::steadyAt(double time) const {
  return std::none_of(targets.begin(), targets.end(),
                      [&](const JointTarget& target) { return target.movesAt(time); });
}

}  // namespace softgauss::gdd

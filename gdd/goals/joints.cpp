// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/joints.hpp"

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

namespace {

/// A goal of joints within an island: of those that are there.
template <class JointGoal>
std::unique_ptr<Goal> ofJointsWithin(const JointGoal& goal, const Model& whole,
                                     const SubModel& island) {
  auto part = std::make_unique<JointGoal>(goal);
  part->targets.clear();
  for (JointTarget target : goal.targets)
    if ((target.body = island.bodyOf(whole, target.body)) > 0) part->targets.push_back(target);
  if (part->targets.empty()) return nullptr;
  return part;
}

}  // namespace

std::unique_ptr<Goal> JointAcceleration::within(const Model& whole, const SubModel& island) const {
  return ofJointsWithin(*this, whole, island);
}

std::unique_ptr<Goal> JointPosture::within(const Model& whole, const SubModel& island) const {
  return ofJointsWithin(*this, whole, island);
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
    const double away = target.value - context.state.q[body.q];
    cost.addDof(body.v, weight * context.data.inertia.M.row(body.v)[body.v],
                stiffness * away - damping * context.state.v[body.v]);
  }
}

}  // namespace softgauss::gdd

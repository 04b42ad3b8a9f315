// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/link_acceleration.hpp"

#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {

LinkAcceleration::LinkAcceleration(const Model& model, const std::string& linkName,
                                   const Vector3& wished, const Vector3& point)
    : link(linkName),
      frame(model.findFrame(linkName)),
      p_FP(point),
      linear(wished),
      weight(kReachWeightPerMass * referenceMass(model, frame)),
      rotationWeight(kRotationWeightPerWeight * weight),
      defaultWeight(weight),
      defaultRotationWeight(rotationWeight) {
  const std::string element = "goal 'acceleration of " + linkName + "'";
  if (frame < 0) throw ModelError({}, element, "the model has no link of that name");
  if (!wished.allFinite() || !point.allFinite())
    throw ModelError({}, element, "acceleration or point is not finite");
}

void LinkAcceleration::addCost(const GoalContext& context, GoalCost& cost) const {
  const Kinematics& k = context.data.kinematics;
  const int body = context.model.frames[frame].body;
  if (context.model.bodies[body].dofs == 0) return;  // fixed to the world
  const LinkRows rows(context, body, framePose(context.model, k, frame) * p_FP, cost.workspace());
  Vector6 wished;
  wished << linear, angular.value_or(Vector3::Zero());
  addLinkCost(context, rows, wished.head(angular ? 6 : 3), {weight, rotationWeight, metric}, cost);
}

}  // namespace softgauss::gdd

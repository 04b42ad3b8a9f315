// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/hold.hpp"

namespace softgauss::gdd {

Hold::Hold(const Model& model, const std::string& linkName)
    : link(linkName),
      frame(model.findFrame(linkName)),
      weight(kReachWeightPerMass * referenceMass(model, frame)),
      rotationWeight(kRotationWeightPerWeight * weight),
      defaultWeight(weight),
      defaultRotationWeight(rotationWeight) {
  if (frame < 0)
    throw ModelError({}, "goal 'hold " + linkName + "'", "the model has no link of that name");
}

void Hold::addCost(const GoalContext& context, GoalCost& cost) const {
  const int body = context.model.frames[frame].body;
  if (context.model.bodies[body].dofs == 0) return;  // fixed to the world
  const Vector3 p = framePose(context.model, context.data.kinematics, frame) * p_FP;
  const LinkRows rows(context, body, p, cost.workspace());
  const Vector6 wished = -rate * rows.velocity;
  addLinkCost(context, rows, wished.head(wholeLink ? 6 : 3), {weight, rotationWeight}, cost);
}

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#include "gdd/goals/reach.hpp"

#include <algorithm>

namespace softgauss::gdd {

Reach::Reach(const Model& model, const std::string& linkName, const Vector3& target,
             const Vector3& point)
    : link(linkName),
      frame(model.findFrame(linkName)),
      p_FP(point),
      p_WTarget(target),
      weight(kReachWeightPerMass * model.totalMass()) {
  const std::string element = "goal 'reach " + linkName + "'";
  if (frame < 0) throw ModelError({}, element, "the model has no link of that name");
  if (!target.allFinite() || !point.allFinite())
    throw ModelError({}, element, "target or point is not finite");
}

Vector3 Reach::position(const GoalContext& context) const {
  return framePose(context.model, context.data.kinematics, frame) * p_FP;
}

std::optional<GoalMark> Reach::mark(const GoalContext& context) const {
  return GoalMark{frame, position(context), p_WTarget};
}

void Reach::addCost(const GoalContext& context, GoalCost& cost) const {
  const Kinematics& k = context.data.kinematics;
  const int body = context.model.frames[frame].body;
  if (context.model.bodies[body].dofs == 0) return;  // fixed to the world
  const Vector3 p = position(context);
  const Vector3 v = pointVelocity(context.model, k, body, p);

  Vector3 wished = stiffness * (p_WTarget - p) - damping * v;
  if (minimumJerk) {
    const double T = minimumJerk->duration;
    const double s = std::clamp((context.state.time - minimumJerk->startTime) / T, 0.0, 1.0);
    const Vector3 way = p_WTarget - minimumJerk->p_start;
    const Vector3 r = minimumJerk->p_start + way * (s * s * s * (10.0 + s * (-15.0 + 6.0 * s)));
    const Vector3 rdot = way * (30.0 * s * s * (1.0 - s) * (1.0 - s) / T);
    const Vector3 rddot = way * (60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (T * T));
    wished = rddot + stiffness * (r - p) + damping * (rdot - v);
  }
  const Vector3 target = wished - pointBiasAcceleration(context.model, k, body, p);
  cost.addPoint(context.model, k, context.data.inertia.sparsity, body, p, weight, target);
}

}  // namespace softgauss::gdd

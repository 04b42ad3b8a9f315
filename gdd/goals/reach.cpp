// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/reach.hpp"

#include <algorithm>

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss::gdd {
double massOfRobot(const Model& model, int robot) {
  double mass = 0.0;
  for (const Body& body : model.bodies)
    if (body.robot == robot) mass += body.mass;
  return mass;
}

double referenceMass(const Model& model, int frame) {
  if (frame < 0) return model.totalMass();
  const int robot = model.bodies[model.frames[frame].body].robot;
  const bool driven = std::any_of(model.dofs.begin(), model.dofs.end(), [&](const Dof& dof) {
    return dof.actuated && model.bodies[dof.body].robot == robot;
  });
  return driven ? massOfRobot(model, robot) : model.totalMass();
}

Reach::Reach(const Model& model, const std::string& linkName, const Vector3& target,
             const Vector3& point)
    : PlaceTarget(target),
      link(linkName),
      frame(model.findFrame(linkName)),
      p_FP(point),
      weight(kReachWeightPerMass * referenceMass(model, frame)),
      rotationWeight(kRotationWeightPerWeight * weight),
      defaultWeight(weight),
      defaultRotationWeight(rotationWeight) {
  const std::string element = "goal 'reach " + linkName + "'";
  if (frame < 0) throw ModelError({}, element, "the model has no link of that name");
  if (!target.allFinite() || !point.allFinite())
    throw ModelError({}, element, "target or point is not finite");
}

Vector3 Reach::position(const GoalContext& context) const {
  return framePose(context.model, context.data.kinematics, frame) * p_FP;
}

std::optional<GoalMark> Reach::mark(const GoalContext& context) const {
  return GoalMark{frame, position(context), targetAt(context.state.time).p};
}

/// r of (9.3).
PointMotion Reach::referenceAt(double time) const {
  const PointMotion to = targetAt(time);
  if (!minimumJerk) return to;
  const CoordinateMotion s = minimumJerkShare(time, minimumJerk->startTime, minimumJerk->duration);
  const Vector3 way = to.p - minimumJerk->p_start;
  return {minimumJerk->p_start + s.p * way, s.v * way + s.p * to.v,
          s.a * way + 2.0 * s.v * to.v + s.p * to.a};
}

Vector3 Reach::wishedAcceleration(double time, const Vector3& p, const Vector3& v) const {
  const PointMotion r = referenceAt(time);
  return r.a + stiffness * (r.p - p) + damping * (r.v - v);
}

Vector3 Reach::wishedRotation(double time, const Matrix3& R, const Vector3& omega) const {
  const auto from = [](const Matrix3& A, const Matrix3& B) {  // rotation vector that turns A into B
    return quaternionLog(Quaternion(Matrix3(B * A.transpose())));
  };
  if (!minimumJerk) return stiffness * from(R, *R_WTarget) - damping * omega;
  const CoordinateMotion s = minimumJerkShare(time, minimumJerk->startTime, minimumJerk->duration);
  const Vector3 turn = from(minimumJerk->R_start, *R_WTarget);
  const Matrix3 now = quaternionExp(s.p * turn).toRotationMatrix() * minimumJerk->R_start;
  return s.a * turn + stiffness * from(R, now) + damping * (s.v * turn - omega);
}

void Reach::addCost(const GoalContext& context, GoalCost& cost) const {
  const Kinematics& k = context.data.kinematics;
  const int body = context.model.frames[frame].body;
  if (context.model.bodies[body].dofs == 0) return;  // fixed to the world
  const Vector3 p = position(context);
  const double time = context.state.time;
  if (!R_WTarget && metric == LinkMetric::euclidean) {
    const Vector3 wished = wishedAcceleration(time, p, pointVelocity(context.model, k, body, p));
    cost.addPoint(context.model, k, context.data.inertia.sparsity, body, p, weight,
                  wished - pointBiasAcceleration(context.model, k, body, p));
    return;
  }
  const LinkRows rows(context, body, p, cost.workspace());
  Vector6 wished;
  wished.head<3>() = wishedAcceleration(time, p, rows.velocity.head<3>());
  if (R_WTarget)
    wished.tail<3>() =
        wishedRotation(time, framePose(context.model, k, frame).R, rows.velocity.tail<3>());
  addLinkCost(context, rows, wished.head(R_WTarget ? 6 : 3), {weight, rotationWeight, metric},
              cost);
}

}  // namespace softgauss::gdd

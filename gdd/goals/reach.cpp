// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/reach.hpp"

#include <algorithm>

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss::gdd {
namespace {

/// The way along a minimum-jerk line, 0 to 1, with its rates.
struct Way {
  double s, sdot, sddot;

  Way(const MinimumJerk& line, double time) {
    const double T = line.duration;
    const double x = std::clamp((time - line.startTime) / T, 0.0, 1.0);
    s = x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
    sdot = 30.0 * x * x * (1.0 - x) * (1.0 - x) / T;
    sddot = 60.0 * x * (1.0 - x) * (1.0 - 2.0 * x) / (T * T);
  }
};

}  // namespace

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
    : link(linkName),
      frame(model.findFrame(linkName)),
      p_FP(point),
      p_WTarget(target),
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
  return GoalMark{frame, position(context), p_WTarget};
}

Vector3 Reach::wishedAcceleration(double time, const Vector3& p, const Vector3& v) const {
  if (!minimumJerk) return stiffness * (p_WTarget - p) - damping * v;
  const Way way(*minimumJerk, time);
  const Vector3 line = p_WTarget - minimumJerk->p_start;
  return way.sddot * line + stiffness * (minimumJerk->p_start + way.s * line - p) +
         damping * (way.sdot * line - v);
}

Vector3 Reach::wishedRotation(double time, const Matrix3& R, const Vector3& omega) const {
  const auto from = [](const Matrix3& A, const Matrix3& B) {  // rotation vector that turns A into B
    return quaternionLog(Quaternion(Matrix3(B * A.transpose())));
  };
  if (!minimumJerk) return stiffness * from(R, *R_WTarget) - damping * omega;
  const Way way(*minimumJerk, time);
  const Vector3 turn = from(minimumJerk->R_start, *R_WTarget);
  const Matrix3 now = quaternionExp(way.s * turn).toRotationMatrix() * minimumJerk->R_start;
  return way.sddot * turn + stiffness * from(R, now) + damping * (way.sdot * turn - omega);
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

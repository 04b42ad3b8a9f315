// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/look_at.hpp"

#include <cmath>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {
namespace {

/// The rotation vector of the shortest rotation that turns the unit vector u into d.
Vector3 turn(const Vector3& u, const Vector3& d) {
  const Vector3 across = u.cross(d);
  const double sine = across.norm(), cosine = u.dot(d);
  if (sine > 1e-12) return across * (std::atan2(sine, cosine) / sine);
  return cosine > 0.0 ? across : Vector3(u.unitOrthogonal() * std::acos(-1.0));
}

}  // namespace

LookAt::LookAt(const Model& model, const std::string& linkName, const Vector3& target,
               const Vector3& axis, const Vector3& point)
    : PlaceTarget(target),
      link(linkName),
      frame(model.findFrame(linkName)),
      axis_F(axis.stableNormalized()),
      p_FP(point),
      weight(kRotationWeightPerWeight * kReachWeightPerMass * referenceMass(model, frame)),
      defaultWeight(weight) {
  const std::string element = "goal 'look_at " + linkName + "'";
  if (frame < 0) throw ModelError({}, element, "the model has no link of that name");
  if (!target.allFinite() || !point.allFinite() || !axis.allFinite())
    throw ModelError({}, element, "target, axis or point is not finite");
  if (axis.stableNorm() == 0.0) throw ModelError({}, element, "the axis is zero");
}

std::optional<GoalMark> LookAt::mark(const GoalContext& context) const {
  const Transform X = framePose(context.model, context.data.kinematics, frame);
  const Vector3 p = X * p_FP, to = targetAt(context.state.time).p;
  return GoalMark{frame, p + (to - p).norm() * (X.R * axis_F), to};
}

void LookAt::addCost(const GoalContext& context, GoalCost& cost) const {
  constexpr double kNearest = 1e-3;
  const int body = context.model.frames[frame].body;
  if (context.model.bodies[body].dofs == 0) return;  // fixed to the world
  const Transform X = framePose(context.model, context.data.kinematics, frame);
  const Vector3 p = X * p_FP, u = X.R * axis_F;
  const PointMotion to = targetAt(context.state.time);
  const double r = (to.p - p).norm();
  if (r < kNearest) return;
  const Vector3 d = (to.p - p) / r;

  const LinkRows rows(context, body, p, cost.workspace());
  const Vector3 v = to.v - rows.velocity.head<3>(), omega = rows.velocity.tail(3);
  const double rdot = d.dot(v);
  const Vector3 ddot = (v - rdot * d) / r;
  const Matrix3 Pi = Matrix3::Identity() - u * u.transpose();
  const Matrix3 across = skew(d) / r;  // ω̇ − α_d = ω̇ + across (p̈ − p̈* + 2 ṙ ḋ)
  const Vector3 wished = stiffness * turn(u, d) - damping * (omega - d.cross(ddot));
  auto J = cost.workspace().rows.topRows(3);
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    const Vector3 point = rows.J.col(i).head<3>(), rotation = rows.J.col(i).tail<3>();
    J.col(i) = Pi * (rotation + across * point);
  }
  const Vector3 bias =
      rows.bias.tail(3) + across * (rows.bias.head<3>() - to.a + 2.0 * rdot * ddot);
  const Vector3 target = Pi * (wished - bias);
  cost.addRows(J, weight, target);
}

}  // namespace softgauss::gdd

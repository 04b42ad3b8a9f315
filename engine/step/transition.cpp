// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/transition.hpp"

#include <cmath>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/step/integrators/implicit_forces.hpp"

namespace softgauss {

Matrix3 rightJacobian(const Vector3& phi) {
  const double angle2 = phi.squaredNorm(), angle = std::sqrt(angle2);
  // (1 − cos θ)/θ² and (θ − sin θ)/θ³; below 0.02 rad the next terms are under 1e-16.
  const bool small = angle2 < 4e-4;
  const double a =
      small ? 0.5 - angle2 / 24.0 + angle2 * angle2 / 720.0 : (1.0 - std::cos(angle)) / angle2;
  const double b = small ? 1.0 / 6.0 - angle2 / 120.0 + angle2 * angle2 / 5040.0
                         : (angle - std::sin(angle)) / (angle2 * angle);
  const Matrix3 S = skew(phi);
  return Matrix3::Identity() - a * S + b * S * S;
}

Transition::Transition(const Data& data, const Model& model)
    : h_(model.options.timestep),
      D1_(VectorX::Constant(model.nv, 0.5 * h_)),
      scaled_(VectorX::Zero(model.nv)) {
  for (const Plan::Spring& spring : data.plan.springs)
    if (isStiffSpring(model, data, spring)) D1_[spring.dof] = 0.0;
  B_ = h_ * (h_ - D1_.array());
  for (const Body& body : model.bodies)
    if (body.joint == JointKind::floating) rotations_.emplace_back().dof = body.v + 3;
  set(VectorX::Zero(model.nv), VectorX::Zero(model.nv));
}

void Transition::set(const VectorX& v, const VectorX& a) {
  for (Rotation& r : rotations_) {
    const double D1 = D1_[r.dof], D2 = h_ - D1;
    const Vector3 omega = v.segment<3>(r.dof), phi1 = D1 * omega,
                  phi2 = D2 * (omega + h_ * a.segment<3>(r.dof));
    const Matrix3 back2 = quaternionExp(-phi2).toRotationMatrix(), J2 = rightJacobian(phi2);
    r.middleByPosition = quaternionExp(-phi1).toRotationMatrix();
    r.middleByVelocity = D1 * rightJacobian(phi1);
    r.A_q = back2 * r.middleByPosition;
    r.A_v = back2 * r.middleByVelocity + D2 * J2;
    r.B = D2 * h_ * J2;
  }
}

void Transition::next(const VectorX& x, const VectorX& da, VectorX& next) const {
  const Eigen::Index n = D1_.size();
  next.head(n) = x.head(n) + h_ * x.tail(n) + B_.cwiseProduct(da);
  next.tail(n) = x.tail(n) + h_ * da;
  for (const Rotation& r : rotations_)
    next.segment<3>(r.dof) =
        r.A_q * x.segment<3>(r.dof) + r.A_v * x.segment<3>(n + r.dof) + r.B * da.segment<3>(r.dof);
}

void Transition::toMiddle(const Model& model, const VectorX& v, VectorX& q) const {
  scaled_ = D1_.cwiseProduct(v);
  integratePosition(model, scaled_, 1.0, q);
}

void Transition::move(const Model& model, const VectorX& a, VectorX& q, VectorX& v) const {
  toMiddle(model, v, q);
  v += h_ * a;
  scaled_ = (h_ - D1_.array()) * v.array();
  integratePosition(model, scaled_, 1.0, q);
}

}  // namespace softgauss

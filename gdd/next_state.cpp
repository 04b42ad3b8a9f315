// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/next_state.hpp"

#include "softgauss/engine/step/integrators/implicit_forces.hpp"
#include "softgauss/engine/step/transition.hpp"

namespace softgauss::gdd {

NextState::NextState(const GoalContext& context, double timestep)
    : model_(&context.model),
      middle_(context.state.q),
      velocity_(context.state.v),
      h_(timestep > 0.0 ? timestep : context.model.options.timestep) {
  const Model& model = context.model;
  const bool drifts = model.options.integrator == Integrator::leapfrog;
  D2_ = VectorX::Constant(model.nv, drifts ? 0.5 * h_ : h_);
  if (drifts)
    for (const Plan::Spring& spring : context.data.plan.springs)
      if (isStiffSpring(model, context.data, spring)) D2_[spring.dof] = h_;
  for (const Body& body : model.bodies)
    if (body.joint == JointKind::floating) rotations_.push_back({body.v + 3, Matrix3::Identity()});
}

void NextState::set(const VectorX& a) {
  v_ = velocity_ + h_ * a;
  drift_ = D2_.cwiseProduct(v_);
  q_ = middle_;
  integratePosition(*model_, drift_, 1.0, q_);
  for (Rotation& r : rotations_) r.B = D2_[r.dof] * h_ * rightJacobian(drift_.segment<3>(r.dof));
}

VectorX NextState::pulledBack(const VectorX& y) const {
  const Eigen::Index n = D2_.size();
  VectorX x = h_ * (D2_.cwiseProduct(y.head(n)) + y.tail(n));
  for (const Rotation& r : rotations_)
    x.segment<3>(r.dof) = r.B.transpose() * y.segment<3>(r.dof) + h_ * y.segment<3>(n + r.dof);
  return x;
}

MatrixX NextState::multiplied(const MatrixX& Y) const {
  const Eigen::Index n = D2_.size();
  MatrixX X = h_ * (Y.leftCols(n) * D2_.asDiagonal()) + h_ * Y.rightCols(n);
  for (const Rotation& r : rotations_)
    X.middleCols<3>(r.dof) = Y.middleCols<3>(r.dof) * r.B + h_ * Y.middleCols<3>(n + r.dof);
  return X;
}

MatrixX NextState::pulledBack(const MatrixX& Y) const {
  return multiplied(multiplied(Y).transpose());
}

}  // namespace softgauss::gdd

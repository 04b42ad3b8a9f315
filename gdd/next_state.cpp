// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/next_state.hpp"

#include "softgauss/engine/step/integrators/implicit_forces.hpp"
#include "softgauss/engine/step/transition.hpp"

namespace softgauss::gdd {

void NextState::begin(const GoalContext& context, double timestep) {
  const Model& model = context.model;
  model_ = &model;
  middle_ = context.state.q, velocity_ = context.state.v;
  h_ = timestep > 0.0 ? timestep : model.options.timestep;
  const bool drifts = model.options.integrator == Integrator::leapfrog;
  // The middle of a longer step lies further on.
  if (drifts && timestep > 0.0)
    integratePosition(model, velocity_, 0.5 * (timestep - model.options.timestep), middle_);
  D2_ = VectorX::Constant(model.nv, drifts ? 0.5 * h_ : h_);
  if (drifts)
    for (const Plan::Spring& spring : context.data.plan.springs)
      if (isStiffSpring(model, context.data, spring)) D2_[spring.dof] = h_;
  rotations_.clear();
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

void NextState::pullBack(const VectorX& y, VectorX& x) const {
  const Eigen::Index n = D2_.size();
  x = h_ * (D2_.cwiseProduct(y.head(n)) + y.tail(n));
  for (const Rotation& r : rotations_)
    x.segment<3>(r.dof) = r.B.transpose() * y.segment<3>(r.dof) + h_ * y.segment<3>(n + r.dof);
}

template <class Matrix>
void NextState::multiply(const Matrix& Y, MatrixX& X) const {
  const Eigen::Index n = D2_.size();
  X = h_ * (Y.leftCols(n) * D2_.asDiagonal()) + h_ * Y.rightCols(n);
  for (const Rotation& r : rotations_)
    X.middleCols<3>(r.dof) =
        Y.template middleCols<3>(r.dof).lazyProduct(r.B) + h_ * Y.template middleCols<3>(n + r.dof);
}

void NextState::pullBack(const MatrixX& Y, MatrixX& once, MatrixX& X) const {
  multiply(Y, once);
  multiply(once.transpose(), X);
}

VectorX NextState::pulledBack(const VectorX& y) const {
  VectorX x;
  pullBack(y, x);
  return x;
}

MatrixX NextState::pulledBack(const MatrixX& Y) const {
  MatrixX once, X;
  pullBack(Y, once, X);
  return X;
}

}  // namespace softgauss::gdd

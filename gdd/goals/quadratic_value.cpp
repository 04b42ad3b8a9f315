// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/quadratic_value.hpp"

#include <limits>

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss::gdd {

QuadraticValue::QuadraticValue(const Model& model)
    : q(model.q0),
      v(VectorX::Zero(model.nv)),
      slope(VectorX::Zero(2 * model.nv)),
      curvature(MatrixX::Zero(2 * model.nv, 2 * model.nv)) {}

void QuadraticValue::addCost(const GoalContext& context, GoalCost& cost) const {
  const Model& model = context.model;
  const int n = model.nv;
  Work& w = work_;
  if (freeControl.size() == n) cost.setFreeControl(freeControl);
  const WarmStart& warm = context.state.warmstart;
  if (about.size() == n)
    w.a = about;
  else if (warm.gddValid && warm.gddA.size() == n)
    w.a = warm.gddA;
  else
    w.a.setZero(n);
  w.next.begin(context, timestep);
  w.next.set(w.a);
  w.difference.resize(n), w.e.resize(2 * n);
  positionDifference(model, q, w.next.q(), w.difference);
  w.e.head(n) = w.difference;
  w.e.tail(n) = w.next.v() - v;
  w.s = slope;
  w.s.noalias() += curvature * w.e;
  w.H = curvature;
  for (const Body& body : model.bodies) {
    if (body.joint != JointKind::floating) continue;
    const int i = body.v + 3;
    Matrix3 J;  // J_r⁻¹(e)
    for (int k = 0; k < 3; ++k) J.col(k) = rotationRate(w.e.segment<3>(i), Vector3::Unit(k));
    w.s.segment<3>(i) = J.transpose() * Vector3(w.s.segment<3>(i));
    for (Eigen::Index k = 0; k < 2 * n; ++k)
      w.H.block<1, 3>(k, i) = Eigen::RowVector3d(w.H.block<1, 3>(k, i)) * J;
    for (Eigen::Index k = 0; k < 2 * n; ++k)
      w.H.block<3, 1>(i, k) = J.transpose() * Vector3(w.H.block<3, 1>(i, k));
  }
  w.next.pullBack(w.s, w.down);
  w.next.pullBack(w.H, w.once, w.K);
  constexpr double kRaised = 1e-10, kSmallest = 1e-14;
  w.K.diagonal().array() += kRaised * w.K.trace() / n + kSmallest;
  w.factor.compute(w.K);
  w.L = w.factor.matrixU();
  w.factor.matrixL().solveInPlace(w.down);
  w.y.noalias() = w.L * w.a;
  w.y -= w.down;
  if (w.factor.info() != Eigen::Success) w.y.setConstant(std::numeric_limits<double>::quiet_NaN());
  cost.addRows(w.L, 1.0, w.y);
}

}  // namespace softgauss::gdd

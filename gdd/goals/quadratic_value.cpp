// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/quadratic_value.hpp"

#include <limits>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/gdd/next_state.hpp"

namespace softgauss::gdd {

QuadraticValue::QuadraticValue(const Model& model)
    : q(model.q0),
      v(VectorX::Zero(model.nv)),
      slope(VectorX::Zero(2 * model.nv)),
      curvature(MatrixX::Zero(2 * model.nv, 2 * model.nv)) {}

void QuadraticValue::addCost(const GoalContext& context, GoalCost& cost) const {
  const Model& model = context.model;
  const int n = model.nv;
  if (freeControl.size() == n) cost.setFreeControl(freeControl);
  const WarmStart& warm = context.state.warmstart;
  VectorX a = VectorX::Zero(n);
  if (about.size() == n)
    a = about;
  else if (warm.gddValid && warm.gddA.size() == n)
    a = warm.gddA;
  NextState next(context, timestep);
  next.set(a);
  VectorX e(2 * n);
  e << positionDifference(model, q, next.q()), next.v() - v;
  VectorX s = slope + curvature * e;
  MatrixX H = curvature;
  for (const Body& body : model.bodies) {
    if (body.joint != JointKind::floating) continue;
    const int i = body.v + 3;
    Matrix3 J;  // J_r⁻¹(e)
    for (int k = 0; k < 3; ++k) J.col(k) = rotationRate(e.segment<3>(i), Vector3::Unit(k));
    s.segment<3>(i) = J.transpose() * s.segment<3>(i).eval();
    H.middleCols<3>(i) = H.middleCols<3>(i).eval() * J;
    H.middleRows<3>(i) = J.transpose() * H.middleRows<3>(i).eval();
  }
  const VectorX down = next.pulledBack(s);
  MatrixX K = next.pulledBack(H);
  constexpr double kRaised = 1e-10, kSmallest = 1e-14;
  K.diagonal().array() += kRaised * K.trace() / n + kSmallest;
  const Eigen::LLT<MatrixX> factor(K);
  const MatrixX L = factor.matrixU();
  VectorX y = L * a - factor.matrixL().solve(down);
  if (factor.info() != Eigen::Success) y.setConstant(std::numeric_limits<double>::quiet_NaN());
  cost.addRows(L, 1.0, y);
}

}  // namespace softgauss::gdd

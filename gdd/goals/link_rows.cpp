// SPDX-License-Identifier: Apache-2.0
#include "gdd/goals/link_rows.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "engine/dynamics/jacobian.hpp"

namespace softgauss::gdd {

LinkRows::LinkRows(const GoalContext& context, int body, const Vector3& p_WP)
    : J(6, context.model.nv) {
  const Kinematics& k = context.data.kinematics;
  Eigen::Matrix<double, 3, Eigen::Dynamic> part(3, context.model.nv);
  pointJacobian(context.model, k, body, p_WP, part);
  J.topRows(3) = part;
  rotationJacobian(context.model, k, body, part);
  J.bottomRows(3) = part;
  bias << pointBiasAcceleration(context.model, k, body, p_WP), k.A_bias[body].angular;
  velocity << pointVelocity(context.model, k, body, p_WP), k.V[body].angular;
}

void addConsistent(const GoalContext& context, const MatrixX& J, const VectorX& weights,
                   const VectorX& target, GoalCost& cost) {
  constexpr double kLeast = 1e-6;
  TreeFactor factor;
  if (!factor.compute(context.data.inertia.M)) return;  // the solver reports it
  MatrixX half(J.cols(), J.rows());                     // M⁻¹Jᵀ
  for (Eigen::Index i = 0; i < J.rows(); ++i) {
    VectorX x = J.row(i);
    factor.solve(x);
    half.col(i) = x;
  }
  MatrixX C = J * half;
  VectorX scale(J.rows());
  for (Eigen::Index i = 0; i < J.rows(); ++i)
    scale[i] = C(i, i) > 0.0 ? 1.0 / std::sqrt(C(i, i)) : 0.0;
  C = scale.asDiagonal() * C * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(C);
  const VectorX& values = eigen.eigenvalues();
  const VectorX unit = scale.cwiseProduct(weights.cwiseSqrt());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!(values[i] > kLeast * values[values.size() - 1])) continue;
    const VectorX row = unit.cwiseProduct(eigen.eigenvectors().col(i)) / std::sqrt(values[i]);
    cost.addRows(row.transpose() * J, 1.0, row.transpose() * target);
  }
}

}  // namespace softgauss::gdd

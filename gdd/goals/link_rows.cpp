// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/link_rows.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "softgauss/engine/dynamics/jacobian.hpp"

namespace softgauss::gdd {

LinkRows::LinkRows(const GoalContext& context, int body, const Vector3& p_WP, GoalWorkspace& work)
    : J(work.J) {
  const Kinematics& k = context.data.kinematics;
  pointJacobian(context.model, k, body, p_WP, J.topRows<3>());
  rotationJacobian(context.model, k, body, J.bottomRows<3>());
  bias << pointBiasAcceleration(context.model, k, body, p_WP), k.A_bias[body].angular;
  velocity << pointVelocity(context.model, k, body, p_WP), k.V[body].angular;
}

namespace {

/// ½ (W½(J a − target))ᵀ (J M⁻¹Jᵀ)⁻¹ (W½(J a − target)), W = diag(weights), for the first rows of
/// J, as many as targets.
void addConsistent(const GoalContext& context, const GoalWorkspace::Rows& J, const Vector6& weights,
                   const Eigen::Ref<const VectorX>& target, GoalCost& cost) {
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;  // not on the heap
  constexpr double kLeast = 1e-6;
  GoalWorkspace& work = cost.workspace();
  TreeFactor& factor = work.massFactor;
  if (!factor.compute(context.data.inertia.M)) return;  // the solver reports it
  const Eigen::Index k = target.size(), n = J.cols();
  // J M⁻¹Jᵀ = Σ over dofs of h hᵀ/D, h the columns of J L⁻¹, M = LᵀDL.
  for (Eigen::Index i = 0; i < k; ++i) {
    work.dofs = J.row(i);
    factor.solveTransposed(work.dofs);
    work.half.row(i) = work.dofs;
  }
  Small C = Small::Zero(k, k);
  for (Eigen::Index dof = 0; dof < n; ++dof)
    for (Eigen::Index i = 0; i < k; ++i)
      for (Eigen::Index j = 0; j < k; ++j)
        C(i, j) += work.half(i, dof) * work.half(j, dof) * factor.inversePivot(int(dof));
  Vector6 scale = Vector6::Zero();
  for (Eigen::Index i = 0; i < k; ++i)
    if (C(i, i) > 0.0) scale[i] = 1.0 / std::sqrt(C(i, i));
  C = (scale.head(k).asDiagonal() * C * scale.head(k).asDiagonal()).eval();
  const Eigen::SelfAdjointEigenSolver<Small> eigen(C);
  const auto& values = eigen.eigenvalues();
  const Vector6 unit = scale.cwiseProduct(weights.cwiseSqrt());
  for (Eigen::Index i = 0; i < k; ++i) {
    if (!(values[i] > kLeast * values[k - 1])) continue;
    Vector6 row = Vector6::Zero();
    row.head(k) = unit.head(k).cwiseProduct(eigen.eigenvectors().col(i)) / std::sqrt(values[i]);
    for (Eigen::Index dof = 0; dof < n; ++dof)
      work.rows(0, dof) = row.head(k).dot(J.col(dof).head(k));
    const Eigen::Matrix<double, 1, 1> wished(row.head(k).dot(target));
    cost.addRows(work.rows.topRows(1), 1.0, wished);
  }
}

}  // namespace

void addLinkCost(const GoalContext& context, const LinkRows& rows,
                 const Eigen::Ref<const VectorX>& wished, const LinkWeights& weights,
                 GoalCost& cost) {
  const Eigen::Index dim = wished.size();
  Vector6 w, target = -rows.bias;
  w << Vector3::Constant(weights.point), Vector3::Constant(weights.rotation);
  target.head(dim) += wished;
  if (weights.metric == LinkMetric::consistent)
    return addConsistent(context, rows.J, w, target.head(dim), cost);
  for (Eigen::Index i = 0; i < dim; i += 3)
    cost.addRows(rows.J.middleRows(i, 3), w[i], target.segment(i, 3));
}

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The cost ℓ(a) that goals put on the acceleration, equation (8) of the paper.
///
/// Goals write residuals; ℓ is their weighted sum (T.21):
///   ℓ(a) = Σ ½ w |J a − y|²  +  ½ aᵀD a + aᵀe  +  ½ m aᵀM a + aᵀM o
/// J: rows of a Jacobian block or any other rows, y: wished value less the bias J̇ v; D, e: of
/// single dofs, D diagonal; m, o: the terms of virtual damping,
/// ½ α (a + βv)ᵀM(a + βv) = ½ α aᵀMa + α β aᵀM v + const.

#include <vector>

#include "engine/constraints/block_jacobian.hpp"
#include "engine/dynamics/inertia.hpp"

namespace softgauss::gdd {

class GoalCost {
 public:
  explicit GoalCost(int dofs)
      : dofWeight_(VectorX::Zero(dofs)),
        dofOffset_(VectorX::Zero(dofs)),
        metricOffset_(VectorX::Zero(dofs)),
        scratch_(VectorX::Zero(dofs)) {}

  void clear();
  /// ½ weight |J a − target|² for the world acceleration J a of the point p_WP of `body`.
  void addPoint(const Model& model, const Kinematics& k, const TreeSparsity& tree, int body,
                const Vector3& p_WP, double weight, const Vector3& target);
  /// ½ weight |J a − target|² for any rows J (k × nv).
  void addRows(const Eigen::Ref<const MatrixX>& J, double weight,
               const Eigen::Ref<const VectorX>& target);
  /// ½ weight (a_dof − target)², up to a constant.
  void addDof(int dof, double weight, double target);
  /// ½ weight (a − target)ᵀ M (a − target), up to a constant.
  void addMetric(double weight, const VectorX& target);

  double metricWeight() const { return metricWeight_; }

  /// ∇ℓ at a; Ma = M a.
  void gradient(const TreeMatrix& M, const VectorX& a, const VectorX& Ma, VectorX& g) const;
  /// ℓ(a) up to its constant.
  double value(const TreeMatrix& M, const VectorX& a, const VectorX& Ma) const;
  /// dᵀ∇²ℓ d; Md = M d.
  double curvatureAlong(const VectorX& d, const VectorX& Md) const;
  /// H ← H + ∇²ℓ without the metric part m M; H holds every pair of dofs.
  void addRowCurvature(TreeMatrix& H);

 private:
  BlockJacobian rows_;
  std::vector<double> weight_;  ///< one a block
  std::vector<Vector3> target_;
  MatrixX dense_;  ///< (nv × room) one column a row of J; the first denseWeight_.size() are in use
  std::vector<double> denseWeight_;
  std::vector<double> denseTarget_;
  VectorX dofWeight_;          ///< D
  VectorX dofOffset_;          ///< e
  double metricWeight_ = 0.0;  ///< m
  VectorX metricOffset_;       ///< o
  mutable VectorX scratch_;
};

}  // namespace softgauss::gdd

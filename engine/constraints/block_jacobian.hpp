// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Jacobian blocks that know which dofs move them.
///
/// A block relates the relative motion of two bodies at a point to the dofs between them:
///   y = J a,   y ∈ R^dim,   J = [d₁ … d_dim]ᵀ (J_B − J_A)
/// Ancestors common to both bodies move neither against the other, so only the two branches below
/// them appear: a few ranges of consecutive dofs (segments), each row of J stored without gaps.

#include <vector>

#include "engine/dynamics/kinematics.hpp"
#include "engine/dynamics/tree_matrix.hpp"

namespace softgauss {

struct JacobianBlock {
  int dim = 0;      ///< rows
  int columns = 0;  ///< entries of a row
  int value = 0;    ///< first coefficient
  int segment = 0;  ///< first segment
  int segmentEnd = 0;
  bool couples = false;  ///< both branches have dofs
};

class BlockJacobian {
 public:
  void clear();
  /// Adds a block for the point p_WP, fixed to body B and seen from body A, along the columns of
  /// `directions` (first `dim` of them, world).
  void add(const Model& model, const Kinematics& k, const TreeSparsity& tree, int bodyA, int bodyB,
           const Vector3& p_WP, const Matrix3& directions, int dim);

  int size() const { return static_cast<int>(blocks_.size()); }
  const JacobianBlock& block(int i) const { return blocks_[i]; }

  /// y ← J_i a.
  void multiply(int i, const VectorX& a, double* y) const;
  /// tau ← tau + J_iᵀ f.
  void addTransposed(int i, const double* f, VectorX& tau) const;
  /// P ← P + J_iᵀ H J_i for a symmetric (dim × dim) H, row-major.
  void addCurvature(int i, const double* H, TreeMatrix& P);
  /// Row `row` of block i, dense.
  void denseRow(int i, int row, Eigen::Ref<Eigen::RowVectorXd> J) const;

  /// Appends the dof sets of blocks that couple two branches.
  void appendCouplings(std::vector<Segment>& segments, std::vector<int>& setEnd) const;

 private:
  std::vector<JacobianBlock> blocks_;
  std::vector<Segment> segments_;
  std::vector<double> values_;
  std::vector<double> scratch_;  ///< H J of one block
};

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Jacobian blocks that know which dofs move them.
///
/// A block relates the relative motion of two bodies to the dofs that cause it:
///   y = J a,   y ∈ R^dim,   J = [d₁ … d_dim]ᵀ (J_B − J_A)
/// J_A, J_B are the Jacobians of a point of each body, or of the bodies' rotation. Where the two
/// points are one, ancestors common to both bodies move neither against the other: then only the
/// two branches below them appear. The dofs are a few ranges (segments), each row of J is stored
/// without gaps.

#include <vector>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/core/memory.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"
#include "softgauss/engine/dynamics/tree_matrix.hpp"

namespace softgauss {

/// What a block measures of the motion of body B as seen from body A: first the velocity of a point
/// of B less that of a point of A, along columns of `linear`, then the relative angular velocity,
/// along columns of `angular`; world axes.
struct RelativeMotion {
  int bodyA = 0, bodyB = 0;
  Vector3 p_WA = Vector3::Zero();  ///< the point of A
  Vector3 p_WB = Vector3::Zero();  ///< the point of B
  Matrix3 linear = Matrix3::Identity();
  int linearDim = 0;  ///< columns used
  Matrix3 angular = Matrix3::Identity();
  int angularDim = 0;
};

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
  void add(const Model& model, const Kinematics& k, const TreeSparsity& tree,
           const RelativeMotion& motion);

  int size() const { return static_cast<int>(blocks_.size()); }
  const JacobianBlock& block(int i) const { return blocks_[idx(i)]; }

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

  /// Memory held [bytes].
  std::size_t bytes() const { return bytesOfAll(blocks_, segments_, values_, scratch_); }

 private:
  std::vector<JacobianBlock> blocks_;
  std::vector<Segment> segments_;
  std::vector<double> values_;
  std::vector<double> scratch_;  ///< H J of one block
};

}  // namespace softgauss

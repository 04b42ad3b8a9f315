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

///
/// The same rows are forces on bodies too (body_rows.hpp): what takes a BodyMotion, a BodyForce or
/// an ArticulatedFactor in place of joint vectors and matrices works with these.

#include <cstdint>
#include <vector>

#include "softgauss/engine/constraints/body_rows.hpp"

namespace softgauss {

struct JacobianBlock {
  int dim = 0;           ///< rows
  int columns = 0;       ///< entries of a row
  int value = 0;         ///< first coefficient
  int segment = 0;       ///< first segment
  int segmentEnd = 0;    ///< −1: the block has no columns, or none yet
  bool couples = false;  ///< both branches have dofs
};

/// When blocks list the dofs that move them.
enum class Columns : std::uint8_t { never, later, now };

class BlockJacobian {
 public:
  void clear();
  /// Without columns, only what is on bodies works: nothing that takes vectors or matrices of dofs.
  void add(const Model& model, const Kinematics& k, const TreeSparsity& tree,
           const RelativeMotion& motion, Columns columns = Columns::now);
  /// Makes room for columns that come later to as many blocks as there is room for.
  void reserveColumns() { motions_.reserve(blocks_.capacity()); }
  /// Lists the dofs of block i, which was to be given them later and has none yet.
  void addColumns(const Model& model, const Kinematics& k, const TreeSparsity& tree, int i);

  int size() const { return static_cast<int>(blocks_.size()); }
  const JacobianBlock& block(int i) const { return blocks_[idx(i)]; }

  /// y ← J_i a.
  void multiply(int i, const VectorX& a, double* y) const;
  void multiply(int i, const BodyMotion& a, double* y) const { bodies_.multiply(i, a.body, y); }
  /// tau ← tau + J_iᵀ f.
  void addTransposed(int i, const double* f, VectorX& tau) const;
  void addTransposed(int i, const double* f, BodyForce& tau) const {
    bodies_.addTransposed(i, f, tau.body);
  }
  /// P ← P + J_iᵀ H J_i for a symmetric (dim × dim) H, row-major.
  void addCurvature(int i, const double* H, TreeMatrix& P);
  void addCurvature(int i, const double* H, ArticulatedFactor& P) const {
    bodies_.addCurvature(i, H, P);
  }
  /// Row `row` of block i, dense.
  void denseRow(int i, int row, Eigen::Ref<Eigen::RowVectorXd> J) const;

  /// Appends the dof sets of blocks that couple two branches.
  void appendCouplings(std::vector<Segment>& segments, std::vector<int>& setEnd) const;

  /// Appends the pairs of bodies that blocks couple.
  void appendPairs(std::vector<std::pair<int, int>>& pairs) const { bodies_.appendPairs(pairs); }

  /// A body that block i moves.
  int bodyOf(int i) const { return bodies_.bodyOf(i); }

  /// Memory held [bytes].
  std::size_t bytes() const {
    return bodies_.bytes() + bytesOfAll(blocks_, motions_, segments_, values_, scratch_);
  }

 private:
  void addColumns(const Model& model, const Kinematics& k, const TreeSparsity& tree,
                  const RelativeMotion& m, JacobianBlock& block);

  BodyRows bodies_;
  std::vector<JacobianBlock> blocks_;
  std::vector<RelativeMotion> motions_;  ///< (blocks) where columns come later
  std::vector<Segment> segments_;
  std::vector<double> values_;
  std::vector<double> scratch_;  ///< H J of one block
};

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Elimination of a matrix on the pattern of a tree that is not symmetric.
///
/// From the leaves to the root, as in tree_matrix.hpp: what dof k leaves behind lies at pairs of
/// dofs above it, which are on one branch, so nothing is filled in. No pivoting: the matrices are
/// M and terms of O(h).

#include "softgauss/engine/dynamics/coriolis_derivative.hpp"

namespace softgauss {

class TreeLu {
 public:
  /// Factors A in its place. False where a pivot is below a thousandth of the diagonal entry that
  /// it comes from, or not finite: the part that is not symmetric has taken over.
  bool compute(const Model& model, TreePair& A);
  /// x ← A⁻¹ x, A as compute() has left it.
  void solve(const Model& model, const TreePair& A, VectorX& x) const;
};

}  // namespace softgauss

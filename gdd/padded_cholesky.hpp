// SPDX-License-Identifier: Apache-2.0
#pragma once

/// K = L Lᵀ of a small dense matrix, by whole vectors: column j of L lies in a row of storage that
/// is padded to a multiple of four, and so do the vectors that are solved for.

#include <vector>

#include "softgauss/engine/core/types.hpp"
#include "softgauss/engine/core/vector_kernels.hpp"

namespace softgauss::gdd {

class PaddedCholesky {
 public:
  /// K by its lower triangle; false when it is not positive definite.
  bool compute(const Eigen::Ref<const MatrixX>& K);

  /// Makes room for K of `n` columns.
  void reserve(int n) {
    L_.reserve(static_cast<std::size_t>(n) * static_cast<std::size_t>(paddedSize(n)));
    inverse_.reserve(static_cast<std::size_t>(n));
  }

  int size() const { return n_; }
  int stride() const { return paddedSize(n_); }
  const double* L() const { return L_.data(); }  ///< column j at j · stride(), zero above
  const double* inverse() const { return inverse_.data(); }  ///< of L's diagonal
  /// x ← L⁻¹x and x ← L⁻ᵀx; x (stride()) has zeros behind its entries, and before `first`.
  void solveLower(double* x, int first = 0) const;
  void solveTransposed(double* x) const;

 private:
  int n_ = 0;
  std::vector<double> L_, inverse_;
};

}  // namespace softgauss::gdd

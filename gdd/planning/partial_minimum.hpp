// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A quadratic function of a and x, minimised over a.
///
///   ½ aᵀQ_aa a + aᵀQ_ax x + ½ xᵀQ_xx x + aᵀQ_a + xᵀQ_x
///
/// With L Lᵀ = Q_aa, (Y y) = L⁻¹(Q_ax Q_a): the minimum is at K x + k = −L⁻ᵀ(Y x + y), and is worth
/// ½ xᵀ(Q_xx − YᵀY)x + xᵀ(Q_x − Yᵀy) + …: Cholesky's algorithm on (a, x, 1), stopped after a.

#include "softgauss/engine/core/types.hpp"
#include "softgauss/gdd/planning/dense_rows.hpp"

namespace softgauss::planning {

class PartialMinimum {
 public:
  /// Of a (n) and x (m).
  PartialMinimum(int n, int m);

  /// Makes the function 0.
  void clear() { Q_.setZero(); }
  /// The function by rows: i of (Q_aa Q_ax Q_a), and of (Q_xx Q_x) from the place of x on. What is
  /// left of the diagonal is not read.
  double* rowOfA(int i) { return Q_[i]; }
  double* rowOfX(int i) { return Q_[first_ + i] + first_; }
  int stride() const { return Q_.stride(); }
  int first() const { return first_; }                     ///< the place of x in a row of a
  int columnsOfX() const { return Q_.stride() - first_; }  ///< of x and 1, padded

  /// Sets Q_xx (m × m) by its lower triangle, and Q_x (m).
  void setX(const MatrixX& Qxx, const VectorX& Qx);
  /// Adds ½ Σ_r W_r (P_r a + G_r x)² for the rows of P (n × n, symmetric) and G (n × m); W (n) ≥ 0.
  void addSquares(const VectorX& W, const MatrixX& P, const MatrixX& G);

  /// False where Q_aa is not positive definite.
  bool factor() { return factorRows(Q_, n_); }
  /// After factor(): K (n × m) and k (n).
  void gain(MatrixX& K, VectorX& k);
  /// After gain(): the minimum by x, less ½ Σ_i E_i (K_i x + k_i)² where E is given (n): its
  /// curvature (m × m, the lower triangle) and slope (m).
  void value(const VectorX* E, MatrixX& curvature, VectorX& slope);

 private:
  int n_, m_, first_;
  DenseRows Q_, rows_;
};

}  // namespace softgauss::planning

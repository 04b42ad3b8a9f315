// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A small convex quadratic program, by the dual active-set method of Goldfarb and Idnani (1983):
///
///   min_p  ½ pᵀK p + qᵀp    subject to   lower ≤ p ≤ upper,   N p ≥ −distance               (10.8)
///
/// K is symmetric positive definite. The method starts at −K⁻¹q and takes in violated constraints
/// one at a time, so linearly dependent rows of N do no harm: one that depends on active rows
/// replaces one of them. Most programs are solved before, by a guess of the face
/// (program_face.hpp).

#include <vector>

#include "softgauss/engine/core/types.hpp"
#include "softgauss/gdd/program_face.hpp"

namespace softgauss::gdd {

class QuadraticProgram {
 public:
  /// Makes room for programs of so many unknowns and rows.
  void reserve(int unknowns, int rows);
  /// Factors K, given by its lower triangle; false when it is not positive definite.
  bool setHessian(const Eigen::Ref<const MatrixX>& K) { return factor_.compute(K); }
  /// Solves for p = 0 feasible. Returns false where rounding kept it from an answer; p is then
  /// feasible up to rounding, but not optimal.
  bool minimize(const VectorX& q, const VectorX& lower, const VectorX& upper,
                const RowMajorMatrixX& N, const VectorX& distance, int rows);
  /// What the program would promise at its solution, had it the gradient q there: the decrease, by
  /// the multipliers that it has.
  double predictedDecrease(const VectorX& q) const;

  const VectorX& solution() const { return p_; }
  double decrease() const { return decrease_; }  ///< −(½ pᵀK p + qᵀp) ≥ 0
  /// Kp + q = boundMultipliers + Nᵀ rowMultipliers; those of a lower bound are ≥ 0, of an upper ≤
  /// 0.
  const VectorX& boundMultipliers() const { return boundMultipliers_; }
  const std::vector<double>& rowMultipliers() const { return rowMultipliers_; }  ///< ≥ 0

 private:
  bool minimizeByDual(const ProgramData& program);
  struct Violation {
    int constraint = -1;
    double amount = 0.0;  ///< b − n·p > 0, over |n|
  };
  Violation mostViolated() const;
  double slack(int constraint) const;
  /// z ← Jᵀ n, J = L⁻ᵀ Q.
  void rotatedNormal(int constraint);
  /// Takes in the constraint whose d_ and z_ are at hand.
  void add(int constraint, double multiplier);
  void drop(int place);

  ProgramFace face_;
  ProgramData program_;
  PaddedCholesky factor_;
  VectorX p_, boundMultipliers_;
  double size_ = 0.0;  ///< of the largest p on the way of the dual method
  std::vector<double> rowMultipliers_;
  double decrease_ = 0.0;
  std::vector<double> norm_;  ///< of the rows of N
  std::vector<char> isActive_;
  std::vector<int> active_;
  std::vector<double> multiplier_;  ///< of the active ones
  MatrixX J_;  ///< L⁻ᵀ Q: JᵀK J = 1, and of the active normals Jᵀn is upper triangular: R
  MatrixX R_;
  VectorX d_, z_, r_;
  mutable std::vector<double> scratch_;
};

}  // namespace softgauss::gdd

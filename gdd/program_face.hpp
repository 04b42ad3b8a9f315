// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The quadratic program (10.8) by guessing its face: the constraints n_c·p ≥ b_c, bounds and rows,
/// that hold with equality. With K = L Lᵀ and w_c = L⁻¹n_c the minimum on a face A is
///
///   p = L⁻ᵀ(Σ_c ν_c w_c − L⁻¹q),      Σ_d (w_c·w_d) ν_d = b_c + w_c·L⁻¹q,      c, d in A
///
/// The primal-dual active set method (Hintermüller, Ito, Kunisch 2003; a semismooth Newton method)
/// then takes in all that is violated, drops all with ν_c < 0, and solves again. Where nothing
/// changes it has the solution; most often at once, if the guess is that of the last step. It need
/// not end: it gives up after a few rounds, or where constraints depend on one another.

#include <vector>

#include "softgauss/gdd/padded_cholesky.hpp"

namespace softgauss::gdd {

/// What (10.8) minimises over; p = 0 is feasible.
struct ProgramData {
  const VectorX* q = nullptr;
  const VectorX* lower = nullptr;
  const VectorX* upper = nullptr;
  const RowMajorMatrixX* N = nullptr;
  const VectorX* distance = nullptr;
  int rows = 0;  ///< of N and distance, that are in use

  /// Constraints by number: lower bounds, upper bounds, rows of N.
  int count() const { return 2 * static_cast<int>(q->size()) + rows; }
};

class ProgramFace {
 public:
  /// Makes room for programs of so many unknowns and rows.
  void reserve(int unknowns, int rows);
  /// From the face on which bounds hold that hold at p = 0, and all rows. False where it gives up.
  bool minimize(const PaddedCholesky& factor, const ProgramData& program);

  const std::vector<double>& solution() const { return p_; }  ///< and padding
  const std::vector<int>& active() const { return active_; }
  const std::vector<double>& multipliers() const { return nu_; }  ///< of the active ones, ≥ 0

 private:
  void addNormal(const PaddedCholesky& factor, const ProgramData& program, int constraint);
  bool solveFace(const PaddedCholesky& factor, const ProgramData& program);
  void growGram(const PaddedCholesky& factor);
  bool solveMultipliers();
  bool changeFace(const PaddedCholesky& factor, const ProgramData& program);

  std::vector<int> active_;
  std::vector<double> W_;     ///< w_c of the active ones, padded
  std::vector<double> rest_;  ///< their b_c, with w_c·L⁻¹q once known
  std::vector<double> size_;  ///< |n_c|
  std::vector<char> isActive_;
  MatrixX G_;            ///< w_c·w_d, lower triangle
  int known_ = 0;        ///< of its rows
  PaddedCholesky gram_;  ///< factor of G_
  std::vector<double> nu_, p_, y_, products_;
  std::vector<int> from_;  ///< where the constraints that stay were
  double force_ = 0.0;     ///< size of q
};

}  // namespace softgauss::gdd

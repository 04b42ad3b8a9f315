// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The problem of goal directed dynamics in dense matrices, coded anew from its formulae: the
/// oracle for everything in gdd/.
///
///   g(a) = M̂ a + c − Jᵀf,  f = D (a_ref − J a), bounded                                   (1.2)
///   F(a) = ½ gᵀR g + ℓ(a),  ℓ(a) = ½ Σ w (A a − y)² + ½ m aᵀM a + aᵀM o + ℓ_f           (8.1)
///   ℓ_f(a) = ½ Σ w_f (B f − y_f)²                                                       (9.19)
///   Φ(a) = F(a) + Σ ½ ρ (t − clamp t)²,  t = C g + λ/ρ                                (10.1)

#include <vector>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::test {

struct DenseGdd {
  MatrixX M;
  MatrixX Mhat;  ///< M and what implicit forces add
  MatrixX Minv;  ///< R, M̂⁻¹ unless a test puts another there
  MatrixX C;     ///< coordinates of force on which the bounds are; empty: the identity
  VectorX c;
  MatrixX J;  ///< rows of contacts and limits
  VectorX aRef, D;
  VectorX forceLower, forceUpper;  ///< bounds of f: they tell the penalties apart
  MatrixX A;                       ///< rows of goals
  VectorX y, w;
  double metric = 0.0;  ///< m
  VectorX offset;       ///< o
  MatrixX B;            ///< (any × rows) of goals of contact forces
  VectorX yf, wf;
  VectorX lower, upper, lambda, rho;

  int dofs() const { return static_cast<int>(M.rows()); }
  int rows() const { return static_cast<int>(J.rows()); }

  VectorX residual(const VectorX& a) const { return J * a - aRef; }
  VectorX force(const VectorX& a) const;  ///< f
  VectorX g(const VectorX& a) const;
  /// M̂ + Jᵀ D J over the stiff rows: those with f within its bounds.
  MatrixX P(const VectorX& a) const;
  /// The breakpoints of a row, ascending, ± ∞ where it has none.
  double lowerKnot(int i) const { return -forceUpper[i] / D[i]; }
  double upperKnot(int i) const { return -forceLower[i] / D[i]; }
  /// Whether row i is stiff at x, or, within `width` of a breakpoint, just past it along dx.
  bool stiff(int i, double x, double dx = 0.0, double width = 0.0) const;

  std::vector<bool> stiffRows(const VectorX& a) const;
  double goalCost(const VectorX& a) const;
  VectorX goalGradient(const VectorX& a) const { return goalGradient(a, stiffRows(a)); }
  /// The same where row i counts as stiff if stiff[i], whatever a says.
  VectorX goalGradient(const VectorX& a, const std::vector<bool>& stiff) const;
  MatrixX goalHessian() const;  ///< without ℓ_f
  /// ∂(B f)/∂a where the row i is stiff if stiff[i].
  MatrixX forceJacobian(const std::vector<bool>& stiff) const;
  MatrixX forceHessian(const VectorX& a) const;  ///< of ℓ_f in the cell

  /// F: what the solver's report calls the objective.
  double objective(const VectorX& a) const;
  VectorX objectiveGradient(const VectorX& a) const;
  /// Φ with the present λ and ρ.
  double augmented(const VectorX& a) const;
  VectorX augmentedGradient(const VectorX& a) const;
  /// P (M⁻¹ + ψ″) P + ∇²ℓ.
  MatrixX gaussNewtonHessian(const VectorX& a) const;

  VectorX coordinates(const VectorX& g) const { return C.size() == 0 ? g : VectorX(C * g); }
  /// Of Σ ψ: in g; in each coordinate.
  VectorX penaltySlope(const VectorX& g) const;
  VectorX penaltyCurvature(const VectorX& g) const;
  /// Distance of C g(a) from the box.
  double violation(const VectorX& a) const;

 private:
  VectorX coordinateSlope(const VectorX& g) const;
};

}  // namespace softgauss::test

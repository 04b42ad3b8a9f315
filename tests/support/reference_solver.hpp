// SPDX-License-Identifier: Apache-2.0
#pragma once

/// An independent solver of the convex problem (13), as an oracle for Newton's method.
///
/// It works on the dual, with dense matrices: with A = J M⁻¹ Jᵀ and R = D⁻¹ the forces are
///   f = argmin  ½ fᵀ(A + R) f + fᵀ(J a_s − a_ref)   subject to f ≥ 0,   a = a_s + M⁻¹ Jᵀ f
/// found by Gauss–Seidel sweeps, one row after another.

#include "engine/core/types.hpp"

namespace softgauss::test {

struct ConvexProblem {
  MatrixX M;     ///< (nv × nv)
  VectorX net;   ///< τ − c (nv)
  MatrixX J;     ///< (rows × nv)
  VectorX aRef;  ///< (rows)
  VectorX D;     ///< (rows)

  /// ½ aᵀM a − aᵀ(τ − c) + Σ ½ D min(J a − a_ref, 0)².
  double cost(const VectorX& a) const;
  /// Its gradient.
  VectorX gradient(const VectorX& a) const;
};

struct ReferenceSolution {
  VectorX a;
  VectorX f;
  int sweeps = 0;
};

/// Sweeps until no force changes by more than `tolerance` of the largest.
ReferenceSolution solveByGaussSeidel(const ConvexProblem& problem, double tolerance = 1e-14,
                                     int maxSweeps = 200000);

}  // namespace softgauss::test

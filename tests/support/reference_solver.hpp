// SPDX-License-Identifier: Apache-2.0
#pragma once

/// An independent solver of the convex problem (13), as an oracle for Newton's method.
///
/// It works on the dual, with dense matrices: with A = J M⁻¹ Jᵀ and R = D⁻¹ the forces are
///   f = argmin  ½ fᵀ(A + R) f + fᵀ(J a_s − a_ref)   subject to lower ≤ f ≤ upper
///   a = a_s + M⁻¹ Jᵀ f
/// found by Gauss–Seidel sweeps, one row after another. The bounds tell the penalties apart: (0, ∞)
/// for a half quadratic, (−∞, ∞) for a quadratic, ± limit for Huber's.

#include "softgauss/engine/core/types.hpp"

namespace softgauss::test {

struct ConvexProblem {
  MatrixX M;             ///< (nv × nv)
  VectorX net;           ///< τ − c (nv)
  MatrixX J;             ///< (rows × nv)
  VectorX aRef;          ///< (rows)
  VectorX D;             ///< (rows)
  VectorX lower, upper;  ///< bounds of the forces (rows)

  /// x = J a − a_ref.
  VectorX residual(const VectorX& a) const;
  /// Forces −D x within their bounds.
  VectorX force(const VectorX& x) const;
  /// ½ aᵀM a − aᵀ(τ − c) + Σ s(x), with s′(x) = −f.
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

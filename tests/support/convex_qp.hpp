// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A dense convex quadratic program, for tests: an oracle, slow and plain.
///
///   min_x  ½ xᵀH x + sᵀx   subject to   E x = e,  C x ≥ b
///
/// H is positive definite on the null space of E. The equalities are eliminated. What is left is
/// the point of a polyhedron that is nearest to the origin, in coordinates in which H is the unit
/// matrix. That point is the residual of a least squares problem with non-negative unknowns
/// (Lawson and Hanson 1974, chapter 23), which an active set method solves in finitely many steps.

#include <limits>
#include <optional>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::test {

struct ConvexQp {
  MatrixX H;
  VectorX s;
  MatrixX E;  ///< (equalities × n), of full row rank
  VectorX e;
  MatrixX C;  ///< (inequalities × n)
  VectorX b;

  double value(const VectorX& x) const { return 0.5 * x.dot(H * x) + s.dot(x); }
  /// Nothing where no x is feasible. `atMost`: nothing either where the minimum without the
  /// inequalities is not below it, so that no more work is done than that tells.
  std::optional<VectorX> solve(double atMost = std::numeric_limits<double>::infinity()) const;
};

/// argmin |A u − f|² over u ≥ 0.
VectorX nonNegativeLeastSquares(const MatrixX& A, const VectorX& f);

}  // namespace softgauss::test

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The problem (8.1) within the cell of a solution, dense.
///
/// Let t solve it with m in the place of the functions φ. As long as no row and no bound changes
/// its piece, all but φ is quadratic, and what else pulls at t is −∇m(t). So
///   q(x) = φ(x) − ∇m(t)ᵀ(x − t) + ½ (x − t)ᵀ Q (x − t)
///   Q = P (R + W) P + ∇²ℓ + c_B P C_BᵀC_B P + c_K J_KᵀJ_K
/// is the whole problem there, up to a constant; ∇²ℓ without φ, B: bounds that y = C g is at, K:
/// rows at their breakpoints, with large c. Its minimum costs a few factorisations of n × n
/// matrices, no solve. It is a guess for all of space, good where the cell at t is the cell of the
/// solution.

#include "softgauss/engine/step/data.hpp"
#include "softgauss/gdd/cost.hpp"
#include "softgauss/gdd/problem.hpp"

namespace softgauss::gdd {

class CellModel {
 public:
  /// Near t, whose force is g: rows, bounds and curvature there. The stage of the rows is evaluated
  /// at t.
  void set(GoalCost& cost, const ControlLimits& limits, Data& data, const VectorX& t,
           const VectorX& g);
  /// A minimum of q, from t on, by Newton's method with line searches.
  const VectorX& minimize(GoalCost& cost, const TreeMatrix& M);

 private:
  void addNonsmoothRows(Constraints& rows, const MatrixX& mass);

  MatrixX P_, Q_;
  VectorX t_, slope_, x_;  ///< t, ∇m(t), the minimum
  std::vector<Crossing> crossings_;
  ContactForceTerms forces_;
};

}  // namespace softgauss::gdd

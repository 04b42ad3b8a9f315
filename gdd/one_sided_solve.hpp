// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Minimises (8.1) where ℓ has one-sided terms (9.22).
///
/// Each such row counts in full, ½ w (y − J a)², or not at all. Where the solution of that problem
/// has y − J a > 0 for the rows that count and ≤ 0 for the others, it is a solution of the whole,
/// for value and gradient are the same. Else the rows take the sides that they have there, and it
/// is solved again from there; a last step's solution says where to begin. One row and a convex
/// rest need at most one change. Where sides go on changing, they do so one at a time, the first
/// row first: with a convex rest that ends (Murty, 1974, on principal pivoting).

#include "softgauss/gdd/sequential_quadratic_solve.hpp"

namespace softgauss::gdd {

/// As SequentialQuadraticSolve::solve(). `between` is memory. Iterations are those of all solves.
/// Status iterationLimit where the sides still change after forty, or no iterations or time are
/// left.
template <class Solver>
GddReport solveOneSided(SequentialQuadraticSolve& expansion, Solver& solver, const Model& model,
                        GoalCost& cost, const ControlLimits& limits, Data& data,
                        const WarmStart& warm, WarmStart& between) {
  constexpr int kTogether = 6, kMost = 40;
  if (cost.hasSides() && warm.gddValid) cost.chooseSides(warm.gddA);
  GddReport total = expansion.solve(solver, model, cost, limits, data, warm);
  if (!cost.hasSides()) return total;
  for (int i = 1; !isRefused(total.status); ++i) {
    if (!cost.chooseSides(expansion.acceleration(), i >= kTogether)) break;
    if (i == kMost || !expansion.mayGoOn()) {
      total.status = GddStatus::iterationLimit;
      break;
    }
    expansion.keepWarmStart(between);
    const GddReport before = total;
    total = expansion.solve(solver, model, cost, limits, data, between);
    total.addCounts(before);
  }
  return total;
}

}  // namespace softgauss::gdd

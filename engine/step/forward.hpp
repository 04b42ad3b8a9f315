// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Forward dynamics by the extended Gauss principle, equation (13) of the paper:
///
///   a = argmin  ½ aᵀM a + aᵀ(c − τ) + s(J a − a_ref)                                 (1.1)
///
/// The objective is strictly convex and piecewise quadratic; its gradient is the inverse dynamics
/// minus τ (1.2) and its curvature is P = M + Jᵀ∇²s J (1.3). Newton's method needs neither M nor J:
/// rows are forces on bodies (body_objective.hpp).

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// (trees) 1 where a guess is the solution, to rounding: rows are evaluated there, and
/// data.forward.gradient is what is left of the equation of motion. Empty: nowhere.
using KnownTrees = std::span<const std::uint8_t>;

/// Acceleration for data.forces.net. Reads the stages up to constraints, writes data.forward.
/// Starts from `guess` (null: none) or the unconstrained acceleration, whichever costs less, but
/// where the guess is known to be the solution.
SolveStatus forwardDynamics(const Model& model, const VectorX* guess, Data& data,
                            KnownTrees known = {}) noexcept;

/// Of Newton's iterations: a step ends in another cell or at the minimum, and the more rows, the
/// more cells lie on the way. Options::maxIterations are for every thousand rows. (200 bodies that
/// fall on each other, with 4,210 rows, have needed more than 100.)
int mostIterations(int option, int rows);

/// x ← (M̂ + diagonal)⁻¹ x, `diagonal` null for M̂ alone, whose factor is used where the last solve
/// left it. False where a pivot is not positive.
bool solveMass(const Model& model, Data& data, const VectorX* diagonal, VectorX& x);

/// forwardDynamics() from the warm start of a state.
inline SolveStatus forwardDynamics(const Model& model, const State& state, Data& data) noexcept {
  return forwardDynamics(model, state.warmstart.valid ? &state.warmstart.a : nullptr, data);
}

}  // namespace softgauss

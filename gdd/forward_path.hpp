// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The exact path a(t) = f(u + t p) of forward dynamics along a ray of controls.
///
/// In a cell it is straight, P ȧ = B p. Where row r meets a breakpoint, P gains Δs″ JᵀJ and
///   ȧ ← ȧ − Δs″ (J ȧ)/(1 + Δs″ J P⁻¹Jᵀ) · P⁻¹Jᵀ                                            (10.9)
/// The row's own rate J ȧ keeps its sign, so the path goes on into the next cell. The path ends at
/// the first local minimum of F along it: inside a cell, at a breakpoint past which F does not
/// descend (a kink), or where the box ends.

#include <vector>

#include "softgauss/engine/step/data.hpp"
#include "softgauss/gdd/cell_response.hpp"
#include "softgauss/gdd/cost.hpp"
#include "softgauss/gdd/held_breakpoints.hpp"

namespace softgauss::gdd {

/// F along the path at its start.
struct PathStart {
  double forceSlope = 0.0;      ///< pᵀBᵀR B u
  double forceCurvature = 0.0;  ///< pᵀBᵀR B p
  double tMax = 1.0;            ///< where the box ends
};

struct PathEnd {
  double t = 0.0;
  double decrease = 0.0;  ///< of F, ≥ 0
  int crossings = 0;
};

class ForwardPath {
 public:
  explicit ForwardPath(const Model& model);
  /// Makes room for paths with so many crossings, and as many held rows, of so many controls.
  void reserve(int crossings, int controls);

  VectorX a;             ///< f(u), moved along the path
  VectorX slope;         ///< ∇ℓ(a) without contact forces, moved along
  double value = 0.0;    ///< ℓ(a) likewise
  HeldBreakpoints held;  ///< rows at breakpoints, and all that paths have crossed

  /// Follows the path from the present point, where ȧ = rate; moves a, ℓ, ∇ℓ and the rows along.
  /// Held rows with a multiplier stay at their breakpoints within the present cell, or come to them
  /// at t = 1. Afterwards `cell` is that of the end, and `held` tells which rows are at
  /// breakpoints. `forces` has what contact forces cost; it is left somewhere on the path.
  PathEnd follow(const PathStart& start, CellResponse& cell, const GoalCost& cost,
                 ContactForceTerms& forces, const VectorX& rate, Data& data);

  /// Moves a and the rows along the path P ȧ = ρ from `rate` = P⁻¹ρ on, until g(a) has grown by ρ.
  /// Returns false when it meets so many breakpoints that Newton's method is the better way.
  bool reach(const VectorX& rate, CellResponse& cell, Data& data);

 private:
  const CellResponse::Correction& cross(const Crossing& crossing, CellResponse& cell,
                                        Constraints& rows);
  bool isBlocked(Breakpoint breakpoint) const;
  void findHeld(const Constraints& rows);

  VectorX rate_, Mrate_, slopeRate_, J_;
  std::vector<Breakpoint> crossed_;
};

}  // namespace softgauss::gdd

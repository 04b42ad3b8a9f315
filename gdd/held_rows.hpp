// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Rows held at their breakpoints: how a Newton method moves along a kink.
///
/// Where the objective's minimum along a ray is a breakpoint of a row r, its gradient jumps there:
/// with the row counted as free it is ∇Φ, with the row stiff ∇Φ + D_r (J_r w) J_rᵀ, w as in (10.2).
/// Steps are then taken within the kink (10.6):
///   H d + J_Kᵀ μ = −∇Φ,   J_K d = −x_K
/// (x_K: how far rounding has moved the held rows off their breakpoints, so that it does not build
/// up). Where the free side is above the breakpoint, σ_r = 1; where it is below, σ_r = −1. The kink
/// is left towards the free side where σ_r μ_r > 0, towards the stiff side where σ_r μ_r < D_r σ_r
/// (J_r w). A point with d = 0 where neither holds for any row at its breakpoint is a local
/// minimum: no direction descends.

#include <vector>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/gdd/contact_force_cost.hpp"

namespace softgauss::gdd {

class HeldRows {
 public:
  struct Row {
    Breakpoint breakpoint;
    double jump = 0.0;        ///< s″ above the breakpoint less s″ below: −σ D
    VectorX J;                ///< (nv)
    VectorX HinvJ;            ///< H⁻¹ Jᵀ
    double drift = 0.0;       ///< x less the breakpoint's, zero up to rounding
    double multiplier = 0.0;  ///< μ
    bool dependent = false;   ///< on rows before it
  };

  explicit HeldRows(int dofs) : dofs_(dofs) {}

  bool empty() const { return count_ == 0; }
  int size() const { return count_; }
  const Row& operator[](int i) const { return rows_[idx(i)]; }
  void clear() { count_ = 0; }
  void hold(Breakpoint breakpoint, const Constraints& constraints);
  void release(int i);

  /// Puts every held row at the free side of its breakpoint, and notes how far off it was.
  void place(Constraints& constraints);
  /// Takes every held row off the ray.
  void holdOnRay(Constraints& constraints) const;

  /// d ← the direction within the kink, from d = −H⁻¹∇Φ. `solve` applies H⁻¹ in place.
  template <class Solve>
  void project(VectorX& d, Solve&& solve) {
    for (int i = 0; i < count_; ++i) {
      rows_[idx(i)].HinvJ = rows_[idx(i)].J;
      solve(rows_[i].HinvJ);
    }
    projectPrepared(d);
  }

  /// The row that most wants to leave, or −1; `towardsStiff` tells to which side. A cost on contact
  /// forces takes the row's pull π from J_r w (10.11).
  int leaving(const VectorX& w, const ContactForceTerms& forces, const Constraints& constraints,
              bool& towardsStiff) const;

 private:
  void projectPrepared(VectorX& d);

  int dofs_;
  int count_ = 0;
  std::vector<Row> rows_;  ///< the first count_ are in use, the rest keep their memory
  MatrixX S_;              ///< Cholesky factor of J_K H⁻¹ J_Kᵀ
};

}  // namespace softgauss::gdd

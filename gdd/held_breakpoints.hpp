// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The rows that the quadratic program of solver 2 keeps in their cell: those that sit at a
/// breakpoint of their penalty, and those that are guarded, since paths have crossed them before.
/// At a point with rows at breakpoints several cells meet, one for each choice of sides.

#include <algorithm>
#include <vector>

#include "softgauss/engine/constraints/constraints.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::gdd {

/// A row above a breakpoint or below it.
struct HeldBreakpoint {
  Breakpoint breakpoint;
  bool atBreakpoint = false;
  int paths = 0;          ///< that have crossed it in this solve
  double distance = 0.0;  ///< from the breakpoint, ≥ 0
  double sign = 1.0;      ///< 1 above the breakpoint, −1 below
  double jump = 0.0;  ///< s″ on the other side less s″ on this one, for a row at its breakpoint
  double multiplier = 0.0;  ///< of its side in the quadratic program, ≥ 0
  VectorX J;                ///< the row (nv)
  VectorX side;  ///< sign · Bᵀ P⁻¹Jᵀ: rate of leaving the breakpoint to this side (controls)
};

/// A list that keeps the memory of what it drops.
class HeldBreakpoints {
 public:
  int size() const { return count_; }
  HeldBreakpoint& operator[](int i) { return breakpoints_[idx(i)]; }
  const HeldBreakpoint& operator[](int i) const { return breakpoints_[idx(i)]; }
  HeldBreakpoint* begin() { return breakpoints_.data(); }
  HeldBreakpoint* end() { return breakpoints_.data() + count_; }
  const HeldBreakpoint* begin() const { return breakpoints_.data(); }
  const HeldBreakpoint* end() const { return breakpoints_.data() + count_; }
  void clear() { count_ = 0; }
  /// Makes room for so many, of a model of so many dofs and controls.
  void reserve(int breakpoints, int dofs, int controls) {
    breakpoints_.resize(std::max(breakpoints_.size(), idx(breakpoints)));
    for (HeldBreakpoint& held : breakpoints_) {
      held.J.resize(dofs);
      held.side.resize(controls);
    }
  }
  /// The entry of a breakpoint, which is new if it was not there.
  HeldBreakpoint& entry(Breakpoint breakpoint) {
    for (HeldBreakpoint& held : *this)
      if (held.breakpoint == breakpoint) return held;
    if (count_ == static_cast<int>(breakpoints_.size())) breakpoints_.emplace_back();
    HeldBreakpoint& fresh = breakpoints_[idx(count_++)];
    fresh.breakpoint = breakpoint;
    fresh.atBreakpoint = false;
    fresh.paths = 0;
    fresh.multiplier = 0.0;
    return fresh;
  }
  int atBreakpoints() const {
    return static_cast<int>(
        std::count_if(begin(), end(), [](const auto& h) { return h.atBreakpoint; }));
  }

 private:
  int count_ = 0;
  std::vector<HeldBreakpoint> breakpoints_;
};

}  // namespace softgauss::gdd

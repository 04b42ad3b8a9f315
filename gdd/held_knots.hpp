// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The rows that the quadratic program of solver 2 keeps in their cell: those that sit at a knot of
/// their penalty, and those that are guarded, since paths have crossed them before. At a point with
/// rows at knots several cells meet, one for each choice of sides.

#include <algorithm>
#include <vector>

#include "engine/constraints/constraints.hpp"

namespace softgauss::gdd {

/// A row above a knot or below it.
struct HeldKnot {
  Knot knot;
  bool atKnot = false;
  int paths = 0;            ///< that have crossed it in this solve
  double distance = 0.0;    ///< from the knot, ≥ 0
  double sign = 1.0;        ///< 1 above the knot, −1 below
  double jump = 0.0;        ///< s″ on the other side less s″ on this one, for a row at its knot
  double multiplier = 0.0;  ///< of its side in the quadratic program, ≥ 0
  VectorX J;                ///< the row (nv)
  VectorX side;  ///< sign · Bᵀ P⁻¹Jᵀ: rate of leaving the knot to this side (controls)
};

/// A list that keeps the memory of what it drops.
class HeldKnots {
 public:
  int size() const { return count_; }
  HeldKnot& operator[](int i) { return knots_[i]; }
  const HeldKnot& operator[](int i) const { return knots_[i]; }
  HeldKnot* begin() { return knots_.data(); }
  HeldKnot* end() { return knots_.data() + count_; }
  const HeldKnot* begin() const { return knots_.data(); }
  const HeldKnot* end() const { return knots_.data() + count_; }
  void clear() { count_ = 0; }
  /// The entry of a knot, which is new if it was not there.
  HeldKnot& entry(Knot knot) {
    for (HeldKnot& held : *this)
      if (held.knot == knot) return held;
    if (count_ == static_cast<int>(knots_.size())) knots_.emplace_back();
    HeldKnot& fresh = knots_[count_++];
    fresh.knot = knot;
    fresh.atKnot = false;
    fresh.paths = 0;
    fresh.multiplier = 0.0;
    return fresh;
  }
  int atKnots() const {
    return static_cast<int>(std::count_if(begin(), end(), [](const auto& h) { return h.atKnot; }));
  }

 private:
  int count_ = 0;
  std::vector<HeldKnot> knots_;
};

}  // namespace softgauss::gdd

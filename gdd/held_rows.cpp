// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/held_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace softgauss::gdd {

void HeldRows::hold(Breakpoint breakpoint, const Constraints& constraints) {
  for (int i = 0; i < count_; ++i)
    if (rows_[i].breakpoint == breakpoint) return;
  if (count_ == static_cast<int>(rows_.size())) {
    rows_.emplace_back();
    rows_.back().J.resize(dofs_);
    S_.resize(count_ + 1, count_ + 1);
  }
  Row& row = rows_[count_++];
  row.breakpoint = breakpoint;
  row.jump = constraints.curvatureJump(breakpoint);
  row.drift = 0.0;
  constraints.breakpointGradient(breakpoint, row.J);
}

void HeldRows::release(int i) {
  for (int k = i; k + 1 < count_; ++k) std::swap(rows_[k], rows_[k + 1]);
  --count_;
}

void HeldRows::place(Constraints& constraints) {
  for (int i = 0; i < count_; ++i) {
    rows_[i].drift = constraints.aboveBreakpoint(rows_[i].breakpoint);
    if (!constraints.piecewiseQuadratic())
      constraints.breakpointGradient(rows_[i].breakpoint, rows_[i].J);
    constraints.placeAtBreakpoint(rows_[i].breakpoint, false);
  }
}

void HeldRows::holdOnRay(Constraints& constraints) const {
  for (int i = 0; i < count_; ++i) constraints.holdOnRay(rows_[i].breakpoint.row);
}

void HeldRows::projectPrepared(VectorX& d) {
  // Cholesky of S = J H⁻¹ Jᵀ, leaving out rows that depend on those before (a pyramid's four
  // edges at their breakpoints have rank three).
  constexpr double kDependent = 1e-9;
  for (int i = 0; i < count_; ++i) {
    Row& row = rows_[i];
    row.multiplier = row.J.dot(d) + row.drift;
    for (int k = 0; k < i; ++k) {
      S_(i, k) = 0.0;
      if (rows_[k].dependent) continue;
      double s = row.J.dot(rows_[k].HinvJ);
      for (int l = 0; l < k; ++l) s -= S_(i, l) * S_(k, l);
      S_(i, k) = s / S_(k, k);
    }
    const double diagonal = row.J.dot(row.HinvJ);
    double pivot = diagonal;
    for (int k = 0; k < i; ++k) pivot -= S_(i, k) * S_(i, k);
    row.dependent = !(pivot > kDependent * diagonal);
    S_(i, i) = row.dependent ? 1.0 : std::sqrt(pivot);
  }
  // μ = S⁻¹ (J d + x)
  for (int i = 0; i < count_; ++i) {
    double m = rows_[i].multiplier;
    for (int k = 0; k < i; ++k) m -= S_(i, k) * rows_[k].multiplier;
    rows_[i].multiplier = rows_[i].dependent ? 0.0 : m / S_(i, i);
  }
  for (int i = count_ - 1; i >= 0; --i) {
    double m = rows_[i].multiplier;
    for (int k = i + 1; k < count_; ++k) m -= S_(k, i) * rows_[k].multiplier;
    rows_[i].multiplier = rows_[i].dependent ? 0.0 : m / S_(i, i);
    d -= rows_[i].multiplier * rows_[i].HinvJ;
  }
}

int HeldRows::leaving(const VectorX& w, const ContactForceTerms& forces,
                      const Constraints& constraints, bool& towardsStiff) const {
  // Descent per unit of the row's own residual, in units of the jump it would face.
  constexpr double kTolerance = 1e-9;
  int worst = -1;
  double most = 0.0;
  for (int i = 0; i < count_; ++i) {
    const Row& row = rows_[i];
    // Of the gradient, from the free to the stiff side, as if the free side were above.
    const double jump = -row.jump * (row.J.dot(w) - forces.pull(row.breakpoint, constraints)),
                 sign = row.jump < 0.0 ? 1.0 : -1.0;
    const double free = sign * row.multiplier, stiff = jump - free;
    const double tolerance = kTolerance * (std::abs(jump) + std::abs(row.multiplier));
    if (free > std::max(most, tolerance)) most = free, worst = i, towardsStiff = false;
    if (stiff > std::max(most, tolerance)) most = stiff, worst = i, towardsStiff = true;
  }
  return worst;
}

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#include "gdd/forward_path.hpp"

#include <algorithm>

namespace softgauss::gdd {
namespace {

/// t past which a row that shall come to its knot at t = 1 has done so, up to rounding.
constexpr double kArrival = 1.0 - 1e-6;

}  // namespace

ForwardPath::ForwardPath(const Model& model) {
  for (VectorX* x : {&a, &rate_, &Ma_, &Mrate_, &gradient_, &J_, &PinvJ_})
    *x = VectorX::Zero(model.nv);
}

PathEnd ForwardPath::follow(const PathStart& start, CellResponse& cell, const GoalCost& cost,
                            const VectorX& rate, Data& data) {
  const TreeMatrix& M = data.inertia.M;
  Constraints& rows = data.constraints;
  rate_ = rate;
  crossed_.clear();
  rows.setRay(rate_);
  for (const HeldKnot& h : held)
    if (h.atKnot && h.multiplier > 0.0) rows.holdOnRay(h.knot.row);

  PathEnd end;
  for (;;) {
    M.multiply(a, Ma_);
    cost.gradient(M, a, Ma_, gradient_);
    const double slope = start.forceSlope + end.t * start.forceCurvature + gradient_.dot(rate_);
    if (!(slope < 0.0)) break;
    M.multiply(rate_, Mrate_);
    const double curvature = start.forceCurvature + cost.curvatureAlong(rate_, Mrate_);
    const double newton = curvature > 0.0 ? -slope / curvature : kInfinity;
    const double length = std::min(newton, start.tMax - end.t);
    const Crossing next = rows.nextCrossing();
    // What the program let come to its knot gets there at t = 1, and not past it.
    const bool arrives =
        end.crossings == 0 && end.t + next.alpha > kArrival && isBlocked(next.knot);
    const bool crosses = next.alpha < length && !arrives;
    const double step = crosses ? next.alpha : length;
    a += step * rate_;
    rows.advance(step);
    end.t += step;
    end.decrease -= step * (slope + 0.5 * step * curvature);
    if (!crosses) break;
    cross(next, cell, rows);
    ++end.crossings;
  }
  if (end.crossings == 0 && end.t > kArrival)
    for (const HeldKnot& h : held)
      if (h.multiplier > 0.0) rows.enterPiece(h.knot, h.sign > 0.0);
  findHeld(rows);
  return end;
}

bool ForwardPath::isBlocked(Knot knot) const {
  return std::any_of(held.begin(), held.end(),
                     [&](const HeldKnot& h) { return h.multiplier > 0.0 && h.knot == knot; });
}

/// (T.62)
void ForwardPath::cross(const Crossing& crossing, CellResponse& cell, Constraints& rows) {
  rows.enterPiece(crossing.knot, crossing.rate > 0.0);
  crossed_.push_back(crossing.knot);
  J_.setZero();
  rows.addRow(crossing.knot.row, 1.0, J_);
  const double scale = cell.cross(J_, crossing.curvatureJump, PinvJ_);
  rate_ -= scale * crossing.rate * PinvJ_;
  rows.setRay(rate_);
}

/// Rows are put exactly at their knots, and no step leaves them there.
void ForwardPath::findHeld(const Constraints& rows) {
  std::sort(crossed_.begin(), crossed_.end());
  crossed_.erase(std::unique(crossed_.begin(), crossed_.end()), crossed_.end());
  for (const Knot& knot : crossed_) ++held.entry(knot).paths;
  for (int i = held.size() - 1; i >= 0; --i) held[i].atKnot = rows.aboveKnot(held[i].knot) == 0.0;
}

}  // namespace softgauss::gdd

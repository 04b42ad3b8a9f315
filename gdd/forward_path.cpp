// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/forward_path.hpp"

#include <algorithm>

#include "softgauss/engine/core/segment_vectors.hpp"

namespace softgauss::gdd {
namespace {

/// t past which a row that shall come to its breakpoint at t = 1 has done so, up to rounding.
constexpr double kArrival = 1.0 - 1e-6;

}  // namespace

ForwardPath::ForwardPath(const Model& model) {
  for (VectorX* x : {&a, &slope, &rate_, &Mrate_, &slopeRate_, &J_}) *x = VectorX::Zero(model.nv);
}

void ForwardPath::reserve(int crossings, int controls) {
  crossed_.reserve(idx(crossings));
  held.reserve(crossings, static_cast<int>(a.size()), controls);
}

PathEnd ForwardPath::follow(const PathStart& start, CellResponse& cell, const GoalCost& cost,
                            ContactForceTerms& forces, const VectorX& rate, Data& data) {
  Constraints& rows = data.constraints;
  const Segments dofs = data.active.dofs();
  rate_ = rate;
  crossed_.clear();
  rows.setRay(rate_);
  for (const HeldBreakpoint& h : held)
    if (h.atBreakpoint && h.multiplier > 0.0) rows.holdOnRay(h.breakpoint.row);

  PathEnd end;
  data.inertia.M.multiply(dofs, rate_, Mrate_);
  cost.multiplyCurvature(rate_, Mrate_, slopeRate_);
  for (;;) {
    const double costSlope = dot(dofs, slope, rate_);
    const double costCurvature = dot(dofs, slopeRate_, rate_);
    double descent = -(start.forceSlope + end.t * start.forceCurvature + costSlope);
    double curvature = start.forceCurvature + costCurvature;
    if (forces.active()) {
      rows.evaluateInPlace();
      rows.setForceRate();
      forces.evaluate(rows);
      forces.setRate(rows);
      descent -= forces.slope();
      curvature += forces.curvature();
    }
    if (!(descent > 0.0)) break;
    const double newton = curvature > 0.0 ? descent / curvature : kInfinity;
    const double length = std::min(newton, start.tMax - end.t);
    const Crossing next = rows.nextCrossing();
    // What the program let come to its breakpoint gets there at t = 1, and not past it.
    const bool arrives =
        end.crossings == 0 && end.t + next.alpha > kArrival && isBlocked(next.breakpoint);
    const bool crosses = next.alpha < length && !arrives;
    const double step = crosses ? next.alpha : length;
    a += step * rate_;
    slope += step * slopeRate_;
    value += step * (costSlope + 0.5 * step * costCurvature);
    rows.advance(step);
    end.t += step;
    end.decrease += step * (descent - 0.5 * step * curvature);
    if (!crosses) break;
    const CellResponse::Correction& c = cross(next, cell, rows);
    slopeRate_ -= c.scale * next.rate * c.Hy;
    crossed_.push_back(next.breakpoint);
    ++end.crossings;
  }
  if (end.crossings == 0 && end.t > kArrival)
    for (const HeldBreakpoint& h : held)
      if (h.multiplier > 0.0) rows.enterPiece(h.breakpoint, h.sign > 0.0);
  findHeld(rows);
  return end;
}

bool ForwardPath::isBlocked(Breakpoint breakpoint) const {
  return std::any_of(held.begin(), held.end(), [&](const HeldBreakpoint& h) {
    return h.multiplier > 0.0 && h.breakpoint == breakpoint;
  });
}

bool ForwardPath::reach(const VectorX& rate, CellResponse& cell, Data& data) {
  constexpr int kMaxCrossings = 12;
  Constraints& rows = data.constraints;
  rate_ = rate;
  rows.setRay(rate_);
  double left = 1.0;
  for (int crossings = 0;; ++crossings) {
    const Crossing next = rows.nextCrossing();
    const double step = std::min(next.alpha, left);
    a += step * rate_;
    rows.advance(step);
    left -= step;
    if (left == 0.0) return true;
    if (crossings == kMaxCrossings) return false;
    cross(next, cell, rows);
  }
}

/// (10.9)
const CellResponse::Correction& ForwardPath::cross(const Crossing& crossing, CellResponse& cell,
                                                   Constraints& rows) {
  rows.enterPiece(crossing.breakpoint, crossing.rate > 0.0);
  J_.setZero();
  rows.addRow(crossing.breakpoint.row, 1.0, J_);
  const CellResponse::Correction& c = cell.cross(J_, crossing.curvatureJump);
  rate_ -= c.scale * crossing.rate * c.y;
  rows.setRay(rate_);
  return c;
}

/// Rows are put exactly at their breakpoints, and no step leaves them there.
void ForwardPath::findHeld(const Constraints& rows) {
  std::sort(crossed_.begin(), crossed_.end());
  crossed_.erase(std::unique(crossed_.begin(), crossed_.end()), crossed_.end());
  for (const Breakpoint& breakpoint : crossed_) ++held.entry(breakpoint).paths;
  for (int i = held.size() - 1; i >= 0; --i)
    held[i].atBreakpoint = rows.aboveBreakpoint(held[i].breakpoint) == 0.0;
}

}  // namespace softgauss::gdd

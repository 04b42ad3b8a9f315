// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/active_set.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "softgauss/engine/step/forward.hpp"

namespace softgauss::gdd {

ActiveSet::ActiveSet(const Model& model) : path_(model) {
  for (VectorX* x : {&force_, &Ma_, &adjoint_, &residual_, &rate_}) *x = VectorX::Zero(model.nv);
  // No more rows stand at their breakpoints than there are dofs, but for those that depend on them.
  for (auto* keys : {&breakpoints_, &first_.breakpoints}) keys->reserve(idx(model.nv));
}

/// B u − g(a), with the rows as they were last evaluated.
void ActiveSet::computeResidual(const Data& data) {
  data.inertia.M.multiply(dofs_, path_.a, Ma_);
  for (const Segment s : dofs_)
    part(residual_, s) = part(force_, s) - part(Ma_, s) -
                         part(data.inertia.added, s).cwiseProduct(part(path_.a, s)) -
                         part(data.forces.c, s);
  data.constraints.addForce(residual_);
}

/// P, S, K and the sides of held rows, in the cell in which the rows are kept; a made exact in it.
bool ActiveSet::enterCell(const GoalCost& cost, Data& data) {
  Constraints& rows = data.constraints;
  if (!entered_ || cell_.needsRefactor()) {
    entered_ = true;
    ++report_.factorizations;
    if (!cell_.enter(data)) return false;
    // Rounding along the path is undone by a Newton step of forward dynamics, exact in a cell.
    rows.setResidual(path_.a);
    rows.evaluateInPlace();
    computeResidual(data);
    cell_.solve(residual_);
    path_.a += residual_;
    evaluateCost(cost, data);
  }

  cell_.computeHessian();
  constrained_.clear();
  for (int i = 0; i < path_.held.size(); ++i) {
    HeldBreakpoint& h = path_.held[i];
    h.multiplier = 0.0;
    if (!h.atBreakpoint && h.paths < kMaxFreeCrossings) continue;
    constrained_.push_back(i);
    const bool above = rows.isAbove(h.breakpoint);
    if (h.atBreakpoint) rows.enterPiece(h.breakpoint, above);
    h.sign = above ? 1.0 : -1.0;
    h.distance = std::max(0.0, h.sign * rows.aboveBreakpoint(h.breakpoint));
    h.jump = -h.sign * rows.curvatureJump(h.breakpoint);
    h.J.resize(force_.size());
    rows.breakpointGradient(h.breakpoint, h.J);
    cell_.multiplyTransposed(h.J, h.side);
    h.side *= h.sign;
  }
  if (forces_.active()) {
    forces_.setJacobian(rows, data.inertia.M.size());
    cell_.addToHessian(forces_);
  }
  return true;
}

/// ∇ℓ at a in the cell in which the rows are kept: with that of contact forces (9.20).
const VectorX& ActiveSet::costSlope(Data& data) {
  if (!forces_.active()) return path_.slope;
  evaluateForces(data);
  costSlope_ = path_.slope;
  forces_.addGradient(data.constraints, costSlope_);
  return costSlope_;
}

/// Whether enterCell() has met all rows that are at their breakpoints: a path may bring another one
/// there.
bool ActiveSet::knowsRowsAtKnots() const {
  std::size_t known = 0;
  for (const int i : constrained_) known += path_.held[i].atBreakpoint;
  return known == static_cast<std::size_t>(path_.held.atBreakpoints());
}

/// q = Bᵀ(R (B u − ĝ) + P⁻¹∇ℓ); false when not finite.
bool ActiveSet::computeGradient(Data& data) {
  cell_.multiplyTransposed(costSlope(data), gradient_);
  merit_ = effort() + cell_.controlCost().freeCost() + std::abs(path_.value - constant_) +
           forces_.value();
  gradient_ += effortSlope_;
  return gradient_.allFinite() && std::isfinite(merit_);
}

/// The step p within the limits and the sides of held rows; returns the decrease it promises, −1
/// where rounding kept it from an answer.
double ActiveSet::solveProgram() {
  ++report_.cells;
  stepLower_ = lower_ - u_;
  stepUpper_ = upper_ - u_;
  const int rows = static_cast<int>(constrained_.size());
  if (sides_.rows() < rows || sides_.cols() != u_.size()) {
    sides_.resize(rows, u_.size());
    distances_.resize(rows);
  }
  for (int k = 0; k < rows; ++k) {
    sides_.row(k) = path_.held[constrained_[k]].side.transpose();
    distances_[k] = path_.held[constrained_[k]].distance;
  }
  if (!program_.setHessian(cell_.hessian())) return -1.0;
  const bool solved =
      program_.minimize(gradient_, stepLower_, stepUpper_, sides_, distances_, rows);
  for (int k = 0; k < rows; ++k)
    path_.held[constrained_[k]].multiplier = program_.rowMultipliers()[k];
  return solved ? program_.decrease() : -1.0;
}

/// Whether the program's step is lost in the rounding of the forces at work. Where no goal asks for
/// anything F has its minimum at 0, and no share of it would end the search.
bool ActiveSet::isRounding(const Data& data) {
  constexpr double kRounding = 1e-14;
  cell_.force(program_.solution(), rate_);
  return largest(dofs_, rate_) <=
         kRounding * std::max(largest(dofs_, data.forces.c), largest(dofs_, force_));
}

/// Moves along the path of the program's solution.
PathEnd ActiveSet::followPath(const GoalCost& cost, Data& data) {
  const VectorX& p = program_.solution();
  PathStart start;
  start.forceSlope = p.dot(effortSlope_);
  cell_.multiplyControlCost(p, best_);
  start.forceCurvature = p.dot(best_);
  cell_.multiply(p, rate_);
  start.tMax = kInfinity;
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    if (p[i] == 0.0) continue;
    start.tMax = std::min(start.tMax, (p[i] > 0.0 ? stepUpper_[i] : stepLower_[i]) / p[i]);
  }
  start.tMax = std::max(1.0, start.tMax);
  for (const HeldBreakpoint& h : path_.held)
    if (h.multiplier > 0.0 && !h.atBreakpoint) start.tMax = 1.0;
  const PathEnd end = path_.follow(start, cell_, cost, forces_, rate_, data);
  effortSlope_ += end.t * best_;
  u_ = (u_ + end.t * p).cwiseMax(lower_).cwiseMin(upper_);
  cell_.force(u_, force_);
  return end;
}

/// (10.10), (10.11). Stationary in this cell: looks for one beside it that descends, and enters it.
ActiveSet::Next ActiveSet::tryNeighbourCell(Data& data) {
  constexpr double kTolerance = 1e-9;
  atBreakpoint_.clear();
  for (int i = 0; i < path_.held.size(); ++i)
    if (path_.held[i].atBreakpoint) atBreakpoint_.push_back(i);
  const int n = static_cast<int>(atBreakpoint_.size());
  const auto row = [&](int k) -> HeldBreakpoint& { return path_.held[atBreakpoint_[k]]; };
  std::uint64_t here = 0;
  for (int k = 0; k < std::min(n, 64); ++k)
    if (row(k).sign > 0.0) here |= std::uint64_t{1} << k;
  const auto tried = [&](std::uint64_t pattern) {
    return std::find(tried_.begin(), tried_.end(), pattern) != tried_.end();
  };
  if (!tried(here)) tried_.push_back(here);

  // w = P⁻¹(∇ℓ − Σ ν σ J): the same in all cells that share it.
  adjoint_ = costSlope(data);
  for (int k = 0; k < n; ++k) adjoint_ -= row(k).multiplier * row(k).sign * row(k).J;
  cell_.solve(adjoint_);
  int worst = -1;
  double least = 0.0;
  bool settled = true;
  for (int k = 0; k < n; ++k) {
    const HeldBreakpoint& h = row(k);
    const double pull = forces_.pull(h.breakpoint, data.constraints);
    const double change = h.sign * h.jump * (dot(dofs_, h.J, adjoint_) + pull);
    const double other = change - h.multiplier;
    const double tolerance = kTolerance * (std::abs(change) + h.multiplier);
    if (other >= -tolerance) continue;
    settled = false;
    if (other < least && !(n <= 64 && tried(here ^ (std::uint64_t{1} << k))))
      least = other, worst = k;
  }
  if (settled) return Next::done;
  if (n > 63) return Next::undecided;
  std::uint64_t pattern = here;
  if (worst >= 0) {
    pattern ^= std::uint64_t{1} << worst;
  } else {
    // Dependent rows have more than one set of multipliers: try all cells, the nearest first.
    if (n > options.maxPatternRows) return Next::undecided;
    const std::uint64_t all = (std::uint64_t{1} << n) - 1;
    int flips = n + 1;
    for (std::uint64_t change = 1; change <= all; ++change) {
      if (std::popcount(change) >= flips || tried(here ^ change)) continue;
      flips = std::popcount(change);
      pattern = here ^ change;
    }
    if (pattern == here) return Next::done;
  }
  for (int k = 0; k < n; ++k) {
    if ((((pattern ^ here) >> k) & 1) == 0) continue;
    data.constraints.enterPiece(row(k).breakpoint, ((pattern >> k) & 1) != 0);
    cell_.cross(row(k).J, row(k).jump);
  }
  return Next::cell;
}

/// a to rounding, the rows as they are there, and the report.
void ActiveSet::finish(const Model& model, const ControlLimits& limits, const GoalCost& cost,
                       Data& data) {
  constexpr int kCorrections = 3;
  constexpr double kRounding = 1e-13;
  const double scale = std::max({1.0, largest(dofs_, data.forces.c), largest(dofs_, force_)});
  setAppliedForce(dofs_, force_, data.forces);
  bool changed = false, anew = false, searched = false;
  for (int k = 0;; ++k) {
    data.constraints.setResidual(path_.a);
    data.constraints.evaluate(changed);
    computeResidual(data);
    exact_ = largest(dofs_, residual_) <= kRounding * scale;
    if (exact_ || searched) break;
    if (k < kCorrections) {
      cell_.solve(residual_);
      path_.a += residual_;
    } else if (!anew) {
      // Rows that were crossed have cost P⁻¹ digits, or one at its breakpoint is in its other
      // piece.
      if (!cell_.enter(data)) break;
      anew = true;
      k = -1;
    } else {
      // Rows at their breakpoints go from piece to piece.
      if (!isRefused(forwardDynamics(model, &path_.a, data))) path_.a = data.forward.a;
      searched = true;
    }
  }
  rate_ = force_ - residual_;  // g(a)
  report_.violation = limits.violation(dofs_, rate_);
  forces_.evaluate(data.constraints);
  path_.value = cost.value(path_.a, Ma_);
  report_.objective = objective();
  report_.heldRows = path_.held.atBreakpoints();
  breakpoints_.clear();
  for (const HeldBreakpoint& held : path_.held)
    if (held.atBreakpoint) breakpoints_.push_back(data.constraints.nameOf(held.breakpoint));
}

/// From where start() has put it. Gives up, with no status, where after some paths the cell still
/// promises no F below `wanted`.
std::optional<GddStatus> ActiveSet::descend(const GoalCost& cost, double wanted, Data& data) {
  constexpr int kPatience = 2;
  HeldBreakpoints& held = path_.held;
  for (;;) {
    if (!enterCell(cost, data) || !computeGradient(data)) return GddStatus::notFinite;
    double predicted = solveProgram();
    if (predicted < 0.0 && !cell_.isFresh()) {
      entered_ = false;  // corrections have cost K too many digits
      continue;
    }
    if (predicted < 0.0) {
      report_.stationarity = 1.0;  // nobody knows
      return GddStatus::undecided;
    }
    if (report_.iterations >= kPatience && objective() - predicted > wanted) return std::nullopt;
    const int heldBefore = held.atBreakpoints();
    bool stationary = predicted <= options.tolerance * merit_ || isRounding(data);
    if (!stationary) {
      if (report_.iterations == options.maxIterations || options.deadline.isOver()) {
        report_.stationarity = predicted / merit_;
        return GddStatus::iterationLimit;
      }
      const PathEnd path = followPath(cost, data);
      ++report_.iterations;
      const bool moved = path.decrease > 1e-3 * options.tolerance * merit_;
      if (moved || held.atBreakpoints() > heldBefore) tried_.clear();
      if (moved && path.crossings == 0) {
        // Still in the cell: its minimum, if rounding has not spoilt it.
        if (!computeGradient(data)) return GddStatus::notFinite;
        predicted = program_.predictedDecrease(gradient_);
        stationary = predicted <= options.tolerance * merit_;
      } else {
        stationary = !moved && path.crossings == 0 && held.atBreakpoints() <= heldBefore;
      }
      // The program must have had a say about every row that is at its breakpoint.
      stationary = stationary && knowsRowsAtKnots();
    }
    if (!stationary) continue;
    report_.stationarity = predicted / std::max(merit_, 1e-300);
    if (held.atBreakpoints() == 0) return GddStatus::converged;
    switch (tryNeighbourCell(data)) {
      case Next::done:
        return GddStatus::nonsmoothMinimum;
      case Next::undecided:
        return GddStatus::undecided;
      case Next::cell:
        if (options.deadline.isOver()) return GddStatus::iterationLimit;
        break;
    }
  }
}

GddReport ActiveSet::solve(const Model& model, GoalCost& cost, const ControlLimits& limits,
                           Data& data, const WarmStart& warm) {
  SOFTGAUSS_ASSERT(data.constraints.piecewiseQuadratic());
  report_ = {};
  exact_ = false;
  searchAge_ = 0;
  searchWait_ = 1;
  if (model.nv == 0) return report_;
  badDof_ = limits.firstBad(model.nv, data.active.dofs());
  if (badDof_ >= 0) {
    report_.status = GddStatus::badLimits;
    return report_;
  }
  constant_ = cost.expansionStart();
  report_.status = start(model, cost, limits, data, warm);
  if (report_.status == GddStatus::notFinite) return report_;
  if (cell_.columns() > 0)
    report_.status = *descend(cost, kInfinity, data);
  else if (!cell_.enter(data))
    report_.status = GddStatus::notFinite;
  if (report_.status == GddStatus::notFinite) return report_;
  finish(model, limits, cost, data);

  if (!known_) return report_;  // a cold start has looked
  if (tree_ < warm.gddSearchAge.size() && tree_ < warm.gddSearchWait.size()) {
    searchAge_ = warm.gddSearchAge[tree_];
    searchWait_ = warm.gddSearchWait[tree_];
  }
  // An expansion of functions is good near its point alone.
  const bool canSearch =
      data.constraints.rowCount() > 0 && cell_.columns() > 0 && !cost.hasFunctions();
  if (!canSearch || options.longestSearchWait == 0 || options.deadline.isOver() ||
      ++searchAge_ < searchWait_)
    return report_;
  searchAge_ = 0;
  const bool found = startAgain(model, cost, limits, data);
  searchWait_ = found ? 1 : std::min(2 * searchWait_, options.longestSearchWait);
  return report_;
}

/// A minimum is local, and a warm start stays with it: looks from u = 0 for a better one, and takes
/// that. Returns whether it has found one.
bool ActiveSet::startAgain(const Model& model, const GoalCost& cost, const ControlLimits& limits,
                           Data& data) {
  constexpr double kBetter = 1e-6;  // of F: less is no reason to leave
  const auto certified = [](const GddReport& report) {
    return report.status == GddStatus::converged || report.status == GddStatus::nonsmoothMinimum;
  };
  first_.a = path_.a;
  first_.u = u_;
  first_.breakpoints = breakpoints_;
  first_.report = report_;
  const double wanted = report_.objective - kBetter * merit_;
  report_ = {};
  tried_.clear();
  path_.held.clear();
  u_.setZero();
  if (std::isfinite(moveTo(model, cost, nullptr, data))) {
    const int most = options.maxIterations;  // of both together
    options.maxIterations = std::max(0, most - first_.report.iterations);
    const std::optional<GddStatus> status = descend(cost, wanted, data);
    options.maxIterations = most;
    report_.status = status.value_or(GddStatus::notFinite);
    if (report_.status != GddStatus::notFinite) finish(model, limits, cost, data);
  } else {
    report_.status = GddStatus::notFinite;
  }
  const GddReport second = report_;
  const bool sound =
      certified(second) || (second.status != GddStatus::notFinite && !certified(first_.report));
  const bool better = sound && second.objective < wanted;
  if (!better) {
    bool changed = false;
    exact_ = false;  // residual_ is the other's
    badDof_ = -1;
    data.stats.badDof = -1;
    report_ = first_.report;
    path_.a = first_.a;
    u_ = first_.u;
    breakpoints_ = first_.breakpoints;
    cell_.force(u_, force_);
    setAppliedForce(dofs_, force_, data.forces);
    data.constraints.setResidual(path_.a);
    data.constraints.evaluate(changed);
  }
  const GddReport& other = better ? first_.report : second;
  report_.iterations += other.iterations;
  report_.cells += other.cells;
  report_.factorizations += other.factorizations;
  report_.forwardIterations += other.forwardIterations;
  return better;
}

}  // namespace softgauss::gdd

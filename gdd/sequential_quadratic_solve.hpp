// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Minimises (8.1) where ℓ has functions that are not quadratic, by successive expansions.
///
/// φ, the sum of the functions, is replaced by its expansion of second order about a point e, and a
/// term that keeps near e may be added:
///   m(a) = φ(e) + ∇φᵀ(a − e) + ½ (a − e)ᵀ([∇²φ] + μ M)(a − e)                              (9.18)
/// [ ] raises eigenvalues against M that are below −0.9 to that: the control cost has at least
/// the curvature M, so that the whole stays convex within a cell. What is left is the problem that
/// the solver knows, contacts, limits and kinks included; its solution is the trial. Trials are
/// feasible to the solver's tolerance; with what the rest is worth, Σ λ (g − its bound), added,
/// their objectives can be compared.
///
/// Where to expand next: all but φ is quadratic in the trial's cell, so φ is minimised with that
/// quadratic first (cell_model.hpp), without a solve. If the solution is in that cell, the next
/// trial is it. What that guess is worth, the solver then says:
///
///   solve with m for φ  →  trial
///   accepted where the objective falls by at least 0.1 of what m promises, or where it stays, to
///   rounding, and ∇φ − ∇m halves
///   done where ∇φ = ∇m at an accepted trial, or where m about the best promises nothing
///   refused, and e was a guess:   e ← the best trial, with μ
///   refused, and e was the best:  μ ← max(4 μ, 1), and more where it happens again
///   otherwise                     e ← the guess from this trial's cell, μ = 0
///
/// At the end the trial solves the problem with φ itself, for the two have the same conditions of
/// first order. A quadratic φ, convex enough, takes one solve; others take two where the first
/// trial is in the right cell. The first trial is compared to nothing.
///
/// With functions this allocates.

#include <algorithm>
#include <cmath>
#include <limits>

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/gdd/augmented_lagrangian.hpp"
#include "softgauss/gdd/cell_model.hpp"

namespace softgauss::gdd {

/// to ← all that a goal directed solve leaves in a warm start.
inline void copySolution(const WarmStart& from, WarmStart& to) {
  to.gddA = from.gddA;
  to.multipliers = from.multipliers;
  to.control = from.control;
  to.breakpoints = from.breakpoints;
  to.gddSearchAge = from.gddSearchAge;
  to.gddSearchWait = from.gddSearchWait;
  to.gddValid = true;
}
/// The same of these trees.
inline void copySolution(const WarmStart& from, const TreeSelection& trees, WarmStart& to) {
  if (trees.all() || to.gddA.size() != from.gddA.size() ||
      to.gddSearchAge.size() != from.gddSearchAge.size())
    return copySolution(from, to);
  for (VectorX WarmStart::*x : {&WarmStart::gddA, &WarmStart::multipliers, &WarmStart::control})
    copy(trees.dofs(), from.*x, to.*x);
  for (const int t : trees.trees()) {
    to.gddSearchAge[idx(t)] = from.gddSearchAge[idx(t)];
    to.gddSearchWait[idx(t)] = from.gddSearchWait[idx(t)];
  }
  to.breakpoints = from.breakpoints;
  to.gddValid = true;
}

class SequentialQuadraticSolve {
 public:
  double tolerance = 1e-8;  ///< of ∇φ − ∇m, scaled as GddReport::stationarity
  int maxSolves = 100;
  /// Iterations that the solves to come may still take together, of which each counts its own.
  int iterationsLeft = std::numeric_limits<int>::max();
  Deadline deadline;  ///< of all solves together

  explicit SequentialQuadraticSolve(const Model& model)
      : a_(VectorX::Zero(model.nv)), force_(VectorX::Zero(model.nv)) {}

  /// Makes room for solutions with so many rows at breakpoints.
  void reserve(int breakpoints) {
    for (WarmStart* warm : {&warm_, &next_})
      warm->breakpoints.reserve(static_cast<std::size_t>(breakpoints));
  }
  /// As Solver::solve(), for a cost with or without functions. Iterations are those of all solves.
  template <class Solver>
  GddReport solve(Solver& solver, const Model& model, GoalCost& cost, const ControlLimits& limits,
                  Data& data, const WarmStart& warm) {
    solves_ = 0;
    if (!cost.hasFunctions()) {
      solves_ = 1;
      const GddReport report = solveOnce(solver, model, cost, limits, data, warm);
      accept(solver, data.active);
      return report;
    }
    warm_ = next_ = warm;
    a_ = warm.gddValid ? warm.gddA : freeAcceleration(data);
    VectorX at = a_;
    bool guessed = false, mayGuess = true;
    double best = kInfinity, bestGap = kInfinity, mu = 0.0, growth = 4.0;
    GddReport total;
    GddStatus bestStatus = total.status = GddStatus::notFinite;
    while (solves_ < maxSolves && (solves_ == 0 || mayGoOn())) {
      if (!cost.expand(data.inertia.M, at, guessed ? 0.0 : mu)) break;
      ++solves_;
      const GddReport report = solveOnce(solver, model, cost, limits, data, warm_);
      if (isRefused(report.status)) return report;
      const VectorX& trial = solver.acceleration();
      solver.keepWarmStart(next_);
      const double error = cost.functionValue(trial) - cost.expansionValue(trial);
      const double bounds = boundsPull(limits, solver.force(), data);
      const double value = report.objective + error + bounds;
      const double predicted = best - (report.objective + bounds);
      const double gap = cost.expansionError(trial, data.inertia.forceScale);
      const double equal = 1e-13 * std::abs(best);
      const bool first = best == kInfinity, still = !guessed && !first && predicted <= equal;
      const bool falls = best - value > equal && best - value >= 0.1 * predicted;
      const bool closes = !first && value <= best + equal && gap < 0.5 * bestGap;
      const bool noBetter = still && mu == 0.0 && !closes;
      if (std::isfinite(value) && (first || falls || closes)) {
        if (!guessed && best - value >= 0.7 * predicted) mu = mu > 1e-3 ? 0.25 * mu : 0.0;
        best = value;
        bestGap = gap;
        bestStatus = report.status;
        accept(solver, data.active);
        const GddReport before = total;
        total = report;
        total.status = GddStatus::iterationLimit;
        total.objective = report.objective + error;
        total.addCounts(before);
        growth = 4.0;
        mayGuess = true;
      } else {
        total.addCounts(report);
        if (guessed) {
          mayGuess = false;
        } else {
          if (still && mu > 0.0) break;  // refused, and nearer promises nothing
          mu = std::max(growth * mu, 1.0);
          growth *= 2.0;
        }
      }
      if (bestGap <= tolerance || noBetter) {
        total.status = bestStatus;
        break;
      }
      guessed = mayGuess && std::isfinite(value);
      if (guessed) {
        cell_.set(cost, limits, data, trial, solver.force());
        at = cell_.minimize(cost, data.inertia.M);
      } else {
        at = a_;
      }
    }
    return total;
  }

  const VectorX& acceleration() const { return a_; }  ///< the solution
  const VectorX& force() const { return force_; }     ///< g there, before clamping
  int solves() const { return solves_; }              ///< of the last solve()
  bool mayGoOn() const { return iterationsLeft > 0 && !deadline.isOver(); }
  /// Writes the solution where the next solve starts from.
  void keepWarmStart(WarmStart& warm) const { copySolution(warm_, warm); }
  /// The same of these trees.
  void keepWarmStart(const TreeSelection& trees, WarmStart& warm) const {
    copySolution(warm_, trees, warm);
  }

 private:
  template <class Solver>
  GddReport solveOnce(Solver& solver, const Model& model, GoalCost& cost,
                      const ControlLimits& limits, Data& data, const WarmStart& warm) {
    const int most = solver.options.maxIterations;
    solver.options.maxIterations = std::min(most, iterationsLeft);
    solver.options.deadline = deadline;
    const GddReport report = solver.solve(model, cost, limits, data, warm);
    solver.options.maxIterations = most;
    iterationsLeft -= std::min(iterationsLeft, report.iterations);
    return report;
  }
  template <class Solver>
  void accept(const Solver& solver, const TreeSelection& trees) {
    copy(trees.dofs(), solver.acceleration(), a_);
    copy(trees.dofs(), solver.force(), force_);
    solver.keepWarmStart(warm_);
  }
  static VectorX freeAcceleration(const Data& data);
  /// Σ λ_i (y_i − its bound) over the bounds that y = C g is at in the last trial.
  double boundsPull(const ControlLimits& limits, const VectorX& g, const Data& data) const;

  VectorX a_, force_;
  WarmStart warm_, next_;  ///< of the best trial, of the last
  CellModel cell_;
  int solves_ = 0;
};

}  // namespace softgauss::gdd

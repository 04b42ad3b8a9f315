// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Minimises (T.17) where ℓ has functions that are not quadratic, by successive expansions.
///
/// φ, the sum of the functions, is replaced by its expansion of second order about a_k, and a term
/// that keeps near a_k is added:
///   m_k(a) = φ(a_k) + ∇φᵀ(a − a_k) + ½ (a − a_k)ᵀ([∇²φ] + μ M)(a − a_k)                    (T.52)
/// [ ] raises eigenvalues against M that are below −0.9 to that: the price of force has at least
/// the curvature M, so that the whole stays convex within a cell. What is left is the problem that
/// the solver knows, contacts, boxes and kinks included; its solution is the trial. Trials are
/// feasible to the solver's tolerance, so their objectives can be compared:
///
///   solve with m_k for φ  →  trial
///   if the objective falls by at least 0.1 of what m_k promises:  a_{k+1} ← trial; where it falls
///                                                    by 0.7 of it, μ ← μ/4, or 0 if small
///   else:                                            μ ← max(4 μ, 1), and more where it happens
///   again until ∇φ = ∇m_k at an accepted trial
/// There the trial solves the problem with φ itself, for the two have the same conditions of first
/// order. A quadratic φ, convex enough, takes one solve. The first trial is compared to nothing.

#include <cmath>

#include "gdd/augmented_lagrangian.hpp"

namespace softgauss::gdd {

class ExpandedSolve {
 public:
  double tolerance = 1e-8;  ///< of ∇φ − ∇m, scaled as GddReport::stationarity
  int maxSolves = 100;

  explicit ExpandedSolve(const Model& model)
      : a_(VectorX::Zero(model.nv)), force_(VectorX::Zero(model.nv)) {}

  /// As Solver::solve(), for a cost with or without functions. Iterations are those of all solves.
  template <class Solver>
  GddReport solve(Solver& solver, const Model& model, GoalCost& cost, const ControlBox& box,
                  Data& data, const WarmStart& warm) {
    if (!cost.hasFunctions()) {
      const GddReport report = solver.solve(model, cost, box, data, warm);
      accept(solver);
      return report;
    }
    warm_ = warm;
    a_ = warm.gddValid ? warm.gddA : freeAcceleration(data);
    double best = kInfinity, mu = 0.0, growth = 4.0;
    GddReport total;
    total.status = GddStatus::notFinite;
    for (int k = 0; k < maxSolves; ++k) {
      if (!cost.expand(data.inertia.M, a_, mu)) break;
      const GddReport report = solver.solve(model, cost, box, data, warm_);
      if (report.status == GddStatus::notFinite) return report;
      const VectorX& trial = solver.acceleration();
      const double promised = best - report.objective;
      const double value =
          report.objective - cost.expansionValue(trial) + cost.functionValue(trial);
      const GddReport before = total;
      const bool rounding = best < kInfinity && promised <= 1e-13 * std::abs(best);
      if (std::isfinite(value) &&
          (best == kInfinity || rounding || best - value >= 0.1 * promised)) {
        const double gap = cost.expansionError(trial, data.inertia.forceScale);
        const double previous = best;
        best = value;
        accept(solver);
        total = report;
        total.objective = value;
        addCounts(before, total);
        if (gap <= tolerance || rounding) return total;
        total.status = GddStatus::iterationLimit;
        if (!(promised < kInfinity) || previous - value >= 0.7 * promised)
          mu = mu > 1e-3 ? 0.25 * mu : 0.0;
        growth = 4.0;
      } else {
        addCounts(report, total);
        mu = std::max(growth * mu, 1.0);
        growth *= 2.0;
      }
    }
    return total;
  }

  const VectorX& acceleration() const { return a_; }  ///< the solution
  const VectorX& force() const { return force_; }     ///< g there, before clamping
  /// Writes the solution where the next solve starts from.
  void keepWarmStart(WarmStart& warm) const {
    warm.gddA = warm_.gddA;
    warm.multipliers = warm_.multipliers;
    warm.gddValid = true;
  }

 private:
  template <class Solver>
  void accept(const Solver& solver) {
    a_ = solver.acceleration();
    force_ = solver.force();
    solver.keepWarmStart(warm_);
  }
  static void addCounts(const GddReport& from, GddReport& to) {
    to.iterations += from.iterations;
    to.dualUpdates += from.dualUpdates;
    to.factorizations += from.factorizations;
  }
  static VectorX freeAcceleration(const Data& data);

  VectorX a_, force_;
  WarmStart warm_;
};

}  // namespace softgauss::gdd

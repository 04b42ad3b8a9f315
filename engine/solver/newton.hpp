// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Newton's method with exact line search for a strictly convex, piecewise quadratic objective.
///
/// Inside a cell (no row of s changes its piece) the objective is a quadratic with one curvature,
/// so a full step that stays in its cell is the solution up to rounding, without a search; the
/// gradient says so. The factorisation is reused as long as the cell does not change. The solver
/// knows no physics.
///
/// Stops when the scaled gradient  max_i |g_i| / scale_i  is at most the tolerance; the scales are
/// the objective's, so that all entries share their unit. Where rounding of stiff pieces keeps the
/// gradient above that, Newton's decrement √(−gᵀd), which is how far the minimum is in the metric
/// of the curvature (Boyd and Vandenberghe, Convex Optimization, 2004, 9.5.1), is held to the same
/// tolerance.

#include <algorithm>
#include <cmath>
#include <concepts>

#include "softgauss/engine/core/types.hpp"
#include "softgauss/engine/solver/line_search.hpp"

namespace softgauss {

enum class SolveStatus {
  converged,           ///< the gradient is within tolerance
  stalled,             ///< no further decrease was possible; residual says how far off
  iterationLimit,      ///< residual says how far off
  notFinite,           ///< the input or the result has a NaN or an infinity
  integratorDiverged,  ///< of a step: the iteration of its integrator has not closed
  badInput  ///< of a step: its input does not fit the model; StepStats::badInput says which
};

/// A step with this status leaves the state as it was.
inline bool isRefused(SolveStatus status) {
  return status == SolveStatus::notFinite || status == SolveStatus::integratorDiverged ||
         status == SolveStatus::badInput;
}

inline const char* statusName(SolveStatus status) {
  switch (status) {
    case SolveStatus::converged:
      return "converged";
    case SolveStatus::stalled:
      return "stalled";
    case SolveStatus::iterationLimit:
      return "iteration limit";
    case SolveStatus::notFinite:
      return "not finite";
    case SolveStatus::integratorDiverged:
      return "integrator diverged";
    case SolveStatus::badInput:
      return "bad input";
  }
  return "unknown";
}

struct NewtonReport {
  SolveStatus status = SolveStatus::converged;
  int iterations = 0;
  int factorizations = 0;
  int lineSearchEvaluations = 0;
  double residual = 0.0;         ///< scaled gradient at the result
  bool roundingLimited = false;  ///< converged as far as rounding lets it, short of the tolerance

  /// With another one that was solved beside it: the worst of both.
  void add(const NewtonReport& other) {
    status = std::max(status, other.status);
    iterations = std::max(iterations, other.iterations);
    factorizations = std::max(factorizations, other.factorizations);
    lineSearchEvaluations = std::max(lineSearchEvaluations, other.lineSearchEvaluations);
    residual = std::max(residual, other.residual);
    roundingLimited = roundingLimited || other.roundingLimited;
  }
};

/// What is minimised. It holds the present point.
template <class O>
concept NewtonObjective = requires(O o, VectorX& g, VectorX& d, double alpha) {
  { o.gradient(g) } -> std::convertible_to<double>;  // g ← ∇; returns its scaled norm
  { o.cellChanged() } -> std::convertible_to<bool>;  // since the last factorize()
  { o.factorize() } -> std::convertible_to<bool>;    // curvature of this cell
  // d ← −(∇²)⁻¹ g, and readies the ray; returns gᵀd.
  { o.direction(g, d) } -> std::convertible_to<double>;
  { o.unit() } -> std::convertible_to<double>;  // decrements of this are a scaled gradient of 1
  // Whether the objective is one quadratic from the point to point + d.
  { o.staysInCell() } -> std::convertible_to<bool>;
  { o.along(alpha) } -> std::convertible_to<Jet>;  // along point + α d
  o.advance(d, alpha);
};

/// Where rounding ends progress before the tolerance: this much of it is still called converged.
inline constexpr double kRoundingFloor = 1e3;

/// From a point whose scaled gradient `residual`, and gradient g, are known.
template <NewtonObjective Objective>
NewtonReport minimize(Objective& objective, double tolerance, int maxIterations, double residual,
                      VectorX& g, VectorX& d) {
  constexpr int kSlowSteps = 3;
  NewtonReport report;
  double previous = kInfinity;
  int slowSteps = 0;
  bool factored = false;
  for (report.residual = residual;; report.residual = objective.gradient(g)) {
    if (!std::isfinite(report.residual)) {
      report.status = SolveStatus::notFinite;
      return report;
    }
    if (report.residual <= tolerance) return report;
    // In an unchanged cell a step that gains less than half has reached rounding. Where the
    // curvature varies, so have several such steps near the tolerance.
    const bool near = report.residual <= kRoundingFloor * tolerance;
    const bool slow = factored && report.residual > 0.5 * previous;
    slowSteps = slow && near ? slowSteps + 1 : 0;
    const bool stuck = (slow && !objective.cellChanged()) || slowSteps == kSlowSteps;
    if (stuck || report.iterations == maxIterations) {
      report.roundingLimited = near;
      if (near) return report;
      report.status = stuck ? SolveStatus::stalled : SolveStatus::iterationLimit;
      return report;
    }
    if (!factored || objective.cellChanged()) {
      ++report.factorizations;
      if (!objective.factorize()) {
        report.status = SolveStatus::notFinite;
        return report;
      }
      factored = true;
    }
    const double slope = objective.direction(g, d);
    if (slow && -slope <= std::pow(tolerance * objective.unit(), 2.0)) {
      report.roundingLimited = true;
      return report;
    }
    LineSearchResult search{.alpha = 1.0};
    if (!objective.staysInCell())
      search = exactLineSearch([&](double alpha) { return objective.along(alpha); }, slope);
    report.lineSearchEvaluations += search.evaluations;
    ++report.iterations;
    if (search.alpha == 0.0) {
      report.roundingLimited = near;
      if (!near) report.status = SolveStatus::stalled;
      return report;
    }
    objective.advance(d, search.alpha);
    previous = report.residual;
  }
}

template <NewtonObjective Objective>
NewtonReport minimize(Objective& objective, double tolerance, int maxIterations, VectorX& g,
                      VectorX& d) {
  return minimize(objective, tolerance, maxIterations, objective.gradient(g), g, d);
}

}  // namespace softgauss

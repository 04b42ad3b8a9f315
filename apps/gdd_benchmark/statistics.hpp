// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Percentiles, and the objectives of two solvers record by record.

#include <vector>

#include "apps/gdd_benchmark/replay.hpp"

namespace softgauss::app {

/// The least value that a share of the values does not exceed; 0 of none.
double percentile(std::vector<double> values, double share);

struct Spread {
  double mean = 0.0, p50 = 0.0, p95 = 0.0, max = 0.0;
  static Spread of(const std::vector<double>& values);
};

/// What the paper's second table says of a solver, and what it leaves out.
struct SolverStatistics {
  Spread iterations, dualUpdates;
  Spread violation;                          ///< GddReport::violation, before clamping [N or N m]
  Spread smoothGradient;                     ///< GddReport::stationarity where no row is held
  Spread smoothIterations, smoothViolation;  ///< of the same records
  Spread forwardIterations;                  ///< of the final forward step
  double kinks = 0.0;                        ///< shares of the records
  double certified = 0.0;                    ///< converged, or a kink that no side of descends
  int atLimit = 0;                           ///< records that ended at the iteration limit
  int unlikeRecorded = 0;                    ///< records with another control than the recorded one
  Spread solveUs, finishUs;
  Spread stepUs;       ///< stages, solve and final forward step
  Spread solveStepUs;  ///< stages and solve

  SolverStatistics(const Replay& replay, const Replay::Solver& solver);
};

/// Objectives of what acts: gap = (second − first) / max(|first|, |second|).
struct Comparison {
  static constexpr double kEqual = 1e-6;  ///< smaller gaps are equality
  int equal = 0, firstBetter = 0, secondBetter = 0;
  Spread firstBetterBy, secondBetterBy;  ///< |gap| where one is better

  Comparison(const std::vector<Solved>& first, const std::vector<Solved>& second);
};

}  // namespace softgauss::app

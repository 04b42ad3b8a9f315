// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a solver of goal directed dynamics tells of its last solve.

#include <algorithm>

namespace softgauss::gdd {

enum class GddStatus {
  converged,
  nonsmoothMinimum,  ///< converged, with rows held at their breakpoints
  iterationLimit,    ///< the best point so far: iterations, or the time, are spent
  nonsmoothStall,    ///< no descent along the direction, past a kink of an elliptic cone: not
                     ///< certified
  undecided,  ///< solver 2: at a kink of more dependent rows than it tries in all combinations, or
              ///< where rounding keeps its quadratic program from an answer
  badLimits,  ///< bounds of a control cross or are not numbers: nothing was solved
  notFinite
};

/// Whether the solve has no control to apply.
constexpr bool isRefused(GddStatus status) {
  return status == GddStatus::badLimits || status == GddStatus::notFinite;
}

struct GddReport {
  GddStatus status = GddStatus::converged;
  int iterations = 0;   ///< solver 1: Newton directions; solver 2: paths followed
  int dualUpdates = 0;  ///< of solver 1
  int factorizations = 0;
  int cells = 0;              ///< solver 2: cells in which a quadratic program was solved
  int heldRows = 0;           ///< rows at their breakpoints at the end
  int restarts = 0;           ///< solver 1: cold, after a warm start that it could not factor
  int forwardIterations = 0;  ///< solver 2: Newton iterations of its one forward solve
  double violation = 0.0;     ///< distance of y(a) from its limits, as force [N or N m]
  /// Solver 1: max |∇Φ + J_Kᵀμ|ᵢ/√M_ii over max(1, max |∇ℓᵢ|/√M_ii). Solver 2: the decrease that
  /// its quadratic program promises still, over the objective; 1 where that has no answer.
  double stationarity = 0.0;
  double objective = 0.0;  ///< ½ gᵀ(R + W) g + ℓ up to ℓ's constant

  /// Adds what another solve has taken: of the same problem, or of one beside it.
  void addCounts(const GddReport& other) {
    iterations += other.iterations;
    dualUpdates += other.dualUpdates;
    factorizations += other.factorizations;
    cells += other.cells;
    forwardIterations += other.forwardIterations;
  }
  /// How it has ended alone: what it has taken is counted elsewhere.
  GddReport withoutCounts() const {
    GddReport ended;
    ended.add(*this);
    ended.iterations = ended.dualUpdates = ended.factorizations = ended.cells =
        ended.forwardIterations = 0;
    return ended;
  }
  /// Adds the earlier parts of a step: what is of the end stays, the rest is the worst.
  void addEarlier(const GddReport& part) {
    addCounts(part);
    status = std::max(status, part.status);
    restarts += part.restarts;
    violation = std::max(violation, part.violation);
    stationarity = std::max(stationarity, part.stationarity);
  }
  /// Adds a problem beside this one: status, violation and stationarity are the worse ones.
  void add(const GddReport& other) {
    addCounts(other);
    status = std::max(status, other.status);
    heldRows += other.heldRows;
    restarts += other.restarts;
    violation = std::max(violation, other.violation);
    stationarity = std::max(stationarity, other.stationarity);
    objective += other.objective;
  }
};

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Takes the recorded steps again, offline, and measures every solver on each.
///
/// For each record, in the order of time, in one thread: the stages that every solve needs
/// (kinematics, M, contacts, rows), then, in turn,
///   forward   forward dynamics at the recorded control, from the acceleration of the step before
///   solve     each solver's goal directed solve, from its own solution of the record before
///   finish    its control clamped, and forward dynamics at it, from the solver's acceleration
/// Who goes first changes from record to record and from pass to pass. Integration is timed
/// nowhere. The clock's figures are the medians over the passes, and all other figures must be the
/// same in each pass.

#include "apps/gdd_benchmark/dataset.hpp"

namespace softgauss::app {

/// One solver on one record.
struct Solved {
  gdd::GddReport report;
  /// ½ uᵀM⁻¹u + ℓ(a), whole, of the control as clamped and the acceleration that it then causes.
  double objective = 0.0;
  int forwardIterations = 0;       ///< of the forward dynamics after it
  bool controlAsRecorded = false;  ///< bit for bit
  double solveUs = 0.0;            ///< of the goal's terms and the solve
  double finishUs = 0.0;
};

struct Replay {
  struct Solver {
    std::string name;
    std::vector<Solved> records;
  };
  std::vector<int> rows;  ///< rows of J, by record
  std::vector<int> forwardIterations;
  std::vector<double> stagesUs, forwardUs;
  std::vector<Solver> solvers;
  int passes = 0;  ///< as many as were completed
};

/// Fewer records or passes on an interrupt. Throws std::runtime_error when a solve becomes
/// non-finite, or when a pass does not repeat the one before it.
Replay replay(const Robot& robot, const Dataset& dataset, const std::vector<std::string>& solvers,
              int passes, Progress& progress);

}  // namespace softgauss::app

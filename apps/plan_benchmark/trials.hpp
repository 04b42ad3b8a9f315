// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A task of planning from random starts, by AILQR and by iLQR over controls.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace softgauss::app {

enum class PlanMethod {
  ailqr,     ///< phases I and F
  feasible,  ///< phase F alone: goal directed passes
  ilqr       ///< phase F with plain controls and the derivatives of the step: iLQR
};
std::string planMethodName(PlanMethod method);

/// One run.
struct PlanTrial {
  double cost = 0.0;
  double rootForce = 0.0, gap = 0.0;
  int iterations = 0;
  double seconds = 0.0;  ///< of the plan
  std::string status;
  /// Of the best feasible trajectory there was, after so many iterations of all stages; a stage's
  /// cost is that on its contacts.
  std::vector<std::pair<int, double>> curve;
};

struct PlanTrials {
  std::string task;
  int dofs = 0, knots = 0;
  double bestKnown = 0.0;  ///< of the file; 0: none
  PlanMethod method = PlanMethod::ailqr;
  double iteration = 0.0;  ///< of one iteration of phase I, at rest and on [s]; 0: it has none
  std::vector<PlanTrial> trials;

  std::vector<double> costs() const;  ///< ascending
  int within(double best, double share) const;
};

struct TrialChoice {
  int starts = 8;
  int iterations = 200;  ///< of phase F alone, and of iLQR, on each of the contacts
  unsigned seed = 1;
  int threads = 1;  ///< over which knots go
};

/// Throws ModelError where the file is at fault.
PlanTrials runTrials(const std::filesystem::path& file, PlanMethod method,
                     const TrialChoice& choice);

/// Draws cost over iterations of each task's first start, its methods side by side, as SVG. Throws
/// std::runtime_error where gnuplot is missing or the file cannot be written.
void drawCurves(const std::vector<PlanTrials>& all, const std::filesystem::path& file);

/// Tables of all tasks, for people.
std::string planTables(const std::vector<PlanTrials>& all);

}  // namespace softgauss::app

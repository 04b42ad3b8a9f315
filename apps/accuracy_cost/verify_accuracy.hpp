// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whether a setting that is chosen for an accuracy keeps it, and is about as fast as the best one.
///
/// chooseForRun(), or chooseSetting() where a problem is cut into windows, sees the problem and
/// nothing else. Its choice is then measured against the
/// study's own reference, and beside the fastest of all settings in the table that are as accurate:
/// the exhaustive search. Problems whose two references differ by more than a tenth of the accuracy
/// are chaotic at that accuracy, and are not counted.

#include <filesystem>

#include "apps/accuracy_cost/study.hpp"

namespace softgauss::app {

struct AccuracyCase {
  std::string problem;
  double accuracy = 0.0;  ///< asked for [m]
  bool counted = false;   ///< not chaotic, and a setting of the table reaches it
  bool found = false;     ///< a setting was chosen
  std::string setting;    ///< the choice
  double error = 0.0;     ///< its true error [m]
  double time = 0.0;      ///< CPU seconds per simulated second
  std::string best;       ///< of the exhaustive search
  double bestTime = 0.0;
  double trialSeconds = 0.0;

  bool whole = true;      ///< it was tried on all of the motion
  double expected = 0.0;  ///< the error that it was expected to have, at the end where not whole

  bool honest() const { return found && error <= accuracy; }
  bool fast() const { return found && time <= 1.5 * bestTime; }
};

/// Accuracies of 1e-2 … 1e-6 m on each problem, with the table of a full run. Prints each case and
/// the shares, and writes verify_accuracy.csv. `wholeSeconds`: as chooseForRun() has it. Returns
/// whether both shares are 95 % or more. `asUsers`: the choice is simulate_gdd's own
/// (user_path.hpp), for problems of one window.
bool verifyAccuracy(const std::filesystem::path& folder, const std::vector<Problem>& problems,
                    const std::vector<Result>& table, const StudyOptions& options,
                    double wholeSeconds, bool asUsers = false);

}  // namespace softgauss::app

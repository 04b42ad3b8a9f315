// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Plans that recede while something disturbs the robot: how many runs end where they should, and
/// what ticks and steps take.
///
/// What floats is pushed at its root in a random horizontal direction for 0.1 s, so that all of it
/// gains the speed that is asked for, at a random time within half a second after the first plan's
/// end. What slides in a plane starts with each velocity off by normal numbers times `disturbed`,
/// what is fixed with scalar joints.

#include <filesystem>
#include <string>
#include <vector>

namespace softgauss::app {

struct RecedingChoice {
  int runs = 20;
  unsigned seed = 1;
  int threads = 1;          ///< over which knots go
  double push = 0.5;        ///< [m/s]
  double disturbed = 0.05;  ///< [rad or m; rad/s or m/s of what slides]
  double timestep = 1e-3;   ///< of the simulator [s]
  double after = 3.0;       ///< for which a run goes on after its push [s]
};

/// One run. It is carried out where it has not lost its plan (PlanControl::isLost()).
struct RecedingRun {
  bool carriedOut = false;
  double planned = 0.0;  ///< final terms where the plan ends
  double final = 0.0;    ///< of the run's end
  int failedTicks = 0;
};

struct RecedingRuns {
  std::string task;
  int dofs = 0;
  bool floats = false, slides = false;
  std::vector<RecedingRun> runs;
  std::vector<double> tickMs, stepUs;  ///< ascending: planning anew, a step with its goals

  int carriedOut() const;
};

/// Throws ModelError where the file is at fault.
RecedingRuns runReceding(const std::filesystem::path& file, const RecedingChoice& choice);

/// A table of all tasks, for people.
std::string recedingTable(const std::vector<RecedingRuns>& all, const RecedingChoice& choice);

}  // namespace softgauss::app

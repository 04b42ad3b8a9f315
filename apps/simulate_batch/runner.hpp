// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Runs some runs of a sweep on the threads of this process and gives their rows.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/simulate_batch/figures.hpp"
#include "apps/simulate_batch/run_table.hpp"
#include "apps/simulate_batch/sweep.hpp"

namespace softgauss::app {

/// What each run plans: the plan of the scene as it is loaded; what differs from run to run is its
/// start and its model. Nothing where the sweep plans nothing. Throws ModelError, also where ticks
/// end by the clock, for runs are to be the same again.
std::optional<io::PlanTask> sweptTask(const Sweep& sweep, const Scene& scene);

class SweepRunner {
 public:
  /// Loads what is swept. Throws ModelError and UsageError.
  SweepRunner(const Sweep& sweep, int threads);

  const SweepRuns& runs() const { return runs_; }
  const Scene& scene() const { return *scene_; }
  const Rollout& rollout() const { return *rollout_; }
  std::string header() const;
  /// All that the rows depend on, in a word: hashes of the files, and the program's version.
  std::string origin() const;

  /// Calls `done` with each row as it comes, in any thread, one at a time; not for runs that `stop`
  /// has cut off.
  void run(const std::vector<long>& runs, const std::function<void(RunRow)>& done,
           const std::atomic<bool>& stop);

 private:
  std::string rowOf(long run, const std::string& outcome, double time,
                    const std::vector<double>& figures, const std::string& failure) const;

  std::unique_ptr<PlanControl> planOf(const Scene& scene) const;

  const Sweep& sweep_;
  std::unique_ptr<Scene> scene_;
  std::optional<io::PlanTask> task_;  ///< what each run plans
  double duration_;                   ///< of each run [s]
  SweepRuns runs_;
  std::unique_ptr<Rollout> rollout_;
  std::vector<std::string> columns_;  ///< of figures
};

}  // namespace softgauss::app

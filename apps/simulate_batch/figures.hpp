// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a run came to, in numbers: what the summary of simulate_gdd tells of it, and the places
/// that the sweep measures.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/simulate_batch/sweep.hpp"
#include "apps/simulate_gdd/goal_record.hpp"
#include "apps/simulate_gdd/standing.hpp"
#include "softgauss/io/simulation/plan_control.hpp"
#include "softgauss/io/simulation/rollout.hpp"

namespace softgauss::app {

class RunFigures {
 public:
  /// At the start of a run, its goals made. `plan`: which it acts out; null where it does not.
  RunFigures(const Sweep& sweep, Simulation& sim, PlanControl* plan = nullptr);

  void before(const Simulation& sim);
  void after(Simulation& sim);
  /// At the end.
  void finish(Simulation& sim);

  /// Of every run of a sweep alike.
  std::vector<std::string> columns() const;
  /// NaN where there is none. Without finish() all are.
  const std::vector<double>& values() const { return values_; }

 private:
  gdd::GoalContext context(const Simulation& sim) const;

  const Sweep& sweep_;
  PlanControl* plan_;
  std::optional<GoalRecord> goals_;
  std::optional<Standing> standing_;
  Kinematics start_;  ///< of the step
  State at_;          ///< q, v and time of the step's start
  std::vector<Snapshot::ContactForce> touching_;
  std::vector<int> frames_;  ///< of the measures
  double penetration_ = 0.0, controlRatio_ = 0.0;
  std::vector<double> values_;
};

}  // namespace softgauss::app

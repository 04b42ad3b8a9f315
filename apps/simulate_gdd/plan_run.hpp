// SPDX-License-Identifier: Apache-2.0
#pragma once

/// --plan and --mpc: what a scene has its robots plan is planned, acted out in the run, and judged.

#include <memory>

#include "apps/simulate_gdd/companion.hpp"
#include "apps/simulate_gdd/options.hpp"
#include "softgauss/io/simulation/plan_control.hpp"

namespace softgauss::app {

/// Reads the scene's plan: options.plan is then its control, options.duration, where none was
/// typed, its length. Throws ModelError.
void readPlan(SimulateOptions& options, const Scene& scene);

/// What is to be planned, for --explain.
std::string explainPlan(const PlanControl& plan);

/// Plans from the scene's start; who is interrupted has no plan: false. Throws PlanError.
bool makePlan(const SimulateOptions& options);

/// What was planned, in a few lines.
std::string planText(const PlanControl& plan);

/// Goes along with the run.
class PlanRun final : public Companion {
 public:
  /// Both must outlive this.
  PlanRun(PlanControl& plan, const State& state) : plan_(plan), state_(state) {}

  bool before(long taken) override;
  void after(const SeenStep& step, const Verdict&) override;
  void tell(const std::string&) override {}
  void finish(long) override {}
  /// What became of the plan.
  void conclude(io::Summary& summary) override;

 private:
  const char* outcomeOf(double final);
  void concludeTicks(io::Summary& summary, io::PlanOutcome& outcome) const;

  PlanControl& plan_;
  const State& state_;
  int ticks_ = 0;
  io::Series tickMs_;
};

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// --plan and --mpc: what a scene has its robots plan is planned, acted out in the run, and judged.

#include <functional>
#include <memory>

#include "apps/simulate_gdd/companion.hpp"
#include "apps/simulate_gdd/options.hpp"
#include "softgauss/io/simulation/plan_control.hpp"

namespace softgauss::app {

/// Reads the scene's plan: options.plan is then its control, options.duration, where none was
/// typed, its length. Throws ModelError.
void readPlan(SimulateOptions& options, const Scene& scene);
/// The same of a task that was read.
void takePlan(SimulateOptions& options, const Scene& scene, io::PlanTask task);

/// What is to be planned, for --explain.
std::string explainPlan(const PlanControl& plan);

/// Plans from the scene's start; who is interrupted has no plan: false. Throws PlanError.
bool makePlan(const SimulateOptions& options);

/// What was planned, in a few lines.
std::string planText(const PlanControl& plan);

/// Goes along with the run.
class PlanRun final : public Companion {
 public:
  using Tell = std::function<void(const std::string&)>;
  /// Both must outlive this. `tell` is told of plans that are made on the way.
  PlanRun(PlanControl& plan, const State& state, Tell tell)
      : plan_(plan), state_(state), tell_(std::move(tell)) {}

  bool before(long taken) override;
  /// Before the next step it is planned from there.
  void moved() override { moved_ = true; }
  void after(const SeenStep& step, const Verdict&) override;
  void tell(const std::string&) override {}
  void finish(long) override {}
  /// What became of the plan.
  void conclude(io::Summary& summary) override;

 private:
  void planFromHere();
  void concludeTicks(io::Summary& summary, io::PlanOutcome& outcome) const;

  PlanControl& plan_;
  const State& state_;
  Tell tell_;
  int ticks_ = 0;
  bool moved_ = false;
  io::Series tickMs_;
};

}  // namespace softgauss::app

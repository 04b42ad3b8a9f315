// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/run_tally.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::app {

void tally(const StepStats& stats, bool countsParts, io::Summary& summary) {
  io::Fallbacks& f = summary.fallbacks;
  f.unconvergedSolves += stats.unconvergedSolves;
  f.roundingLimitedSolves += stats.roundingLimitedSolves;
  f.invalidWarmStarts += stats.invalidWarmStarts;
  f.abandonedTrees += stats.abandonedTrees;
  f.stabilisedBodies += stats.stabilisedBodies;
  f.minimumStepsAccepted += stats.minimumStepsAccepted;
  f.possibleTunnelling += stats.possibleTunnelling;
  io::IntegrationCounts& i = summary.integration;
  i.evaluations += stats.evaluations;
  i.substeps += stats.substeps;
  i.parts += countsParts ? stats.parts : 0;
  i.repeats += stats.repeats;
  i.rejections += stats.rejections;
  i.tunnellingSplits += stats.tunnellingSplits;
  io::SleepOutcomes& s = summary.sleep;
  ++s.steps;
  s.asleep += stats.asleepTrees;
  s.wakeups += stats.wokenTrees;
  s.most = std::max(s.most, stats.asleepTrees);
  for (const MechanismName& m : kMechanismNames)
    summary.mechanismActs[static_cast<std::size_t>(m.mechanism)] += stats.acted[m.mechanism];
}

void tally(const gdd::GddReport& report, io::GddOutcomes& outcomes) {
  outcomes.restarts += report.restarts;
  switch (report.status) {
    case gdd::GddStatus::converged:
      ++outcomes.certified;
      break;
    case gdd::GddStatus::nonsmoothMinimum:
      ++outcomes.nonsmoothMinima;
      break;
    case gdd::GddStatus::iterationLimit:
      ++outcomes.iterationLimit;
      break;
    case gdd::GddStatus::nonsmoothStall:
      ++outcomes.nonsmoothStalls;
      break;
    case gdd::GddStatus::undecided:
      ++outcomes.undecided;
      break;
    case gdd::GddStatus::badLimits:
    case gdd::GddStatus::notFinite:
      break;
  }
}

void tallyCommands(const gdd::GoalDirectedController& controller, io::Summary& summary) {
  for (Eigen::Index k = 0; k < controller.commands.size(); ++k) {
    const gdd::Actuator& actuator =
        controller.limits.transmission->actuators()[static_cast<std::size_t>(k)];
    const double bound = std::max(-actuator.lower, actuator.upper);
    if (std::isfinite(bound) && bound > 0.0)
      summary.addControlRatio(actuator.name, std::abs(controller.commands[k]) / bound);
  }
}

}  // namespace softgauss::app

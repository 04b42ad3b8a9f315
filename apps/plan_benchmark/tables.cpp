// SPDX-License-Identifier: Apache-2.0
/// The tables of plan_benchmark.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "apps/plan_benchmark/trials.hpp"

namespace softgauss::app {
namespace {

/// What is asked: costs within 1 % of the best known one, in all starts but one of eight.
constexpr double kWithin = 0.01, kShare = 7.0 / 8.0;
/// And of a plan.
constexpr double kGap = 1e-10;

std::string mark(bool holds) { return holds ? " " : "!"; }

}  // namespace

std::string planTables(const std::vector<PlanTrials>& all) {
  std::map<std::string, double> best;
  for (const PlanTrials& t : all) {
    const auto [at, isNew] = best.emplace(t.task, t.bestKnown > 0.0 ? t.bestKnown : 1e300);
    for (const PlanTrial& trial : t.trials) at->second = std::min(at->second, trial.cost);
  }
  std::string out =
      fmt::format("{:<16}{:<9}{:>4}{:>4}{:>10}{:>10}{:>10}{:>10}{:>7} {:>8}{:>9}{:>12}{:>9}\n",
                  "task", "method", "dof", "N", "known", "best", "median", "worst", "1 %", "10 %",
                  "plan ms", "phase I ms", "gap");
  for (const PlanTrials& t : all) {
    const std::vector<double> costs = t.costs();
    if (costs.empty()) continue;
    const double known = best[t.task];
    double seconds = 0.0, gap = 0.0, root = 0.0;
    for (const PlanTrial& trial : t.trials) {
      seconds += trial.seconds / static_cast<double>(t.trials.size());
      if (trial.cost < 1e300)
        gap = std::max(gap, trial.gap), root = std::max(root, trial.rootForce);
    }
    const auto count = static_cast<double>(costs.size());
    const int near = t.within(known, kWithin);
    out += fmt::format(
        "{:<16}{:<9}{:>4}{:>4}{:>10.4g}{:>10.4g}{:>10.4g}{:>10.4g}{:>5}/{}{}"
        "{:>6}/{}{:>9.1f}{:>12}{:>9.1g}{}\n",
        t.task, planMethodName(t.method), t.dofs, t.knots, known, costs.front(),
        costs[costs.size() / 2], costs.back(), near, costs.size(), mark(near >= kShare * count),
        t.within(known, 0.1), costs.size(), 1e3 * seconds,
        t.iteration > 0.0 ? fmt::format("{:.3f}", 1e3 * t.iteration) : "", gap,
        mark(gap <= kGap && root == 0.0));
  }
  return out + fmt::format(
                   "\n!: fewer than {:.1f} % of the starts within 1 % of the least cost "
                   "known, or a gap above {:.0e}, or a root force\n",
                   100.0 * kShare, kGap);
}

}  // namespace softgauss::app

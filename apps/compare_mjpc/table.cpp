// SPDX-License-Identifier: Apache-2.0
/// The table of compare_mjpc.

#include <fmt/format.h>

#include <cmath>

#include "apps/compare_mjpc/plan_race.hpp"

namespace softgauss::app {
namespace {

/// A cost; none where every rollout has diverged, or there is none yet.
std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : "none"; }

std::string milliseconds(double seconds) {
  return std::isfinite(seconds) ? fmt::format("{:.3g}", 1e3 * seconds) : "never";
}

std::string settings(const PlanRace& race) {
  if (race.ilqg.points.empty()) return "";
  return fmt::format("{}, J{}{}", race.settings.ofValue ? "value" : "control",
                     race.settings.scale == 1.0 ? "" : fmt::format(" x {:g}", race.settings.scale),
                     race.softFirst ? ", planning contacts first" : "");
}

}  // namespace

std::string planRaceTable(const std::vector<PlanRace>& races) {
  constexpr const char* kRow =
      "{:<16}{:>4}{:>4}{:>9}{:>9}{:>11}{:>11}{:>9}{:>11}{:>9}{:>11}{:>12}{:>12}  {}\n";
  std::string out = fmt::format(fmt::runtime(kRow), "task", "dof", "N", "ours", "ms", "iLQG then",
                                "its end", "ms", "median", "to ours", "we to its", "it from us",
                                "we from it", "its settings");
  for (const PlanRace& r : races)
    out += fmt::format(
        fmt::runtime(kRow), r.task, r.dofs, r.knots, number(r.ours.cost()),
        milliseconds(r.ours.seconds()), number(r.ilqg.costAt(r.ours.seconds())),
        number(r.ilqg.cost()), milliseconds(r.ilqg.seconds()),
        r.ends.empty() ? "" : number(r.ends[r.ends.size() / 2]),
        milliseconds(r.ilqg.secondsTo(kSameEnd * r.ours.cost())),
        r.ilqg.points.empty() ? "" : milliseconds(r.ours.secondsTo(kSameEnd * r.ilqg.cost())),
        number(r.ilqgFromOurs), number(r.oursFromIlqg), settings(r));
  return out +
         fmt::format(
             "\nCPU times in ms, the least of the repeats; a cost within {:.0f} % is reached. "
             "median: of the ends of all its settings\n",
             100.0 * (kSameEnd - 1.0));
}

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "io/summary.hpp"

namespace softgauss::io {
namespace {

/// A column's number: what is whole stays whole, the rest has about three significant digits.
std::string cell(double x) {
  if (!std::isfinite(x)) return fmt::format("{}", x);
  if (x == std::round(x) && std::abs(x) < 1e6) return fmt::format("{:.0f}", x);
  const double size = std::abs(x);
  if (size < 1e-3 || size >= 1e6) return fmt::format("{:.1e}", x);
  if (size < 10.0) return fmt::format("{:.2f}", x);
  return fmt::format("{:.0f}", x);
}

void addRow(std::string& out, const char* what, const char* unit, const Series& series) {
  const std::string name = *unit ? fmt::format("{} [{}]", what, unit) : std::string(what);
  fmt::format_to(std::back_inserter(out), "  {:<26}{:>10}{:>10}{:>10}{:>10}\n", name,
                 cell(series.percentile(0.5)), cell(series.percentile(0.95)), cell(series.max()),
                 cell(series.mean()));
}

std::string millimetres(double metres) { return fmt::format("{:.3g} mm", 1e3 * metres); }

double percentNearer(const GoalOutcome& goal) { return 100.0 * goal.nearer(); }

std::string verdict(const std::string& outcome, const std::vector<GoalOutcome>& goals) {
  if (goals.empty()) return outcome;
  const auto worst =
      std::min_element(goals.begin(), goals.end(), [](const GoalOutcome& a, const GoalOutcome& b) {
        return percentNearer(a) < percentNearer(b);
      });
  const double percent = percentNearer(*worst);
  const std::string name = goals.size() == 1 ? worst->name : "worst goal, " + worst->name;
  if (percent >= 0.0)
    return fmt::format("{}: {}: {:.0f} % of the way, {} left", outcome, name, percent,
                       millimetres(worst->finalError));
  return fmt::format("{}: {}: moved away, {} from {}", outcome, name,
                     millimetres(worst->finalError), millimetres(worst->initialError));
}

}  // namespace

std::string Summary::table() const {
  std::string out;
  const auto add = [&](const std::string& line) { out += line + "\n"; };
  add(fmt::format("{}: {} links, {} dof, {} actuated, {:.4g} kg", modelName_, links_, dofs_,
                  actuated_, massKg));
  add(fmt::format("  {:.4g} s simulated in {:.3g} s, {:.3g} x real time; {} steps of {:.4g} ms, {}",
                  simulatedSeconds(), wallSeconds, realTimeFactor(), steps_, 1e3 * timestep_,
                  integrator));
  add(fmt::format("  effects: {}", fmt::join(effects, " ")));
  add("");
  add(fmt::format("  {:<26}{:>10}{:>10}{:>10}{:>10}", "", "p50", "p95", "max", "mean"));
  addRow(out, "step", "µs", stepUs_);
  addRow(out, "  forward", "µs", forwardUs_);
  if (gddUs_.max() > 0.0) addRow(out, "  goal directed", "µs", gddUs_);
  addRow(out, "constraint rows", "", constraints_);
  addRow(out, "iterations", "", iterations_);
  if (gddUs_.max() > 0.0) addRow(out, "dual updates", "", dualUpdates_);
  addRow(out, "physics violation", "N, N m", physicsViolation_);
  if (gddUs_.max() > 0.0) {
    addRow(out, "GDD violation", "N, N m", gddViolation_);
    addRow(out, "stationarity", "", stationarity_);
    addRow(out, "realised, relative", "", realised_);
  }
  if (gdd.all() > 0)
    add(fmt::format("  minima of goals: {:.4g} % certified, {:.3g} % of all at kinks",
                    100.0 * static_cast<double>(gdd.certified + gdd.kinks) / gdd.all(),
                    100.0 * static_cast<double>(gdd.kinks) / gdd.all()));
  if (integration.evaluations > 0)
    add(fmt::format(
        "  integration: {} evaluations of the dynamics, {} parts of steps, {} more tried "
        "and shortened, {} taken in spite of their error, {} cut short lest shapes pass unseen",
        integration.evaluations, integration.substeps, integration.rejections, fallbacks.jumps,
        integration.glances));
  else if (integration.parts > static_cast<long>(steps_) || integration.repeats > 1)
    add(fmt::format("  integration: {} parts of {} steps, {} solves repeated", integration.parts,
                    steps_, integration.repeats));
  if (islands.on)
    add(fmt::format("  islands: up to {}, {:.3g} % of them asleep over the run, {} woken",
                    islands.most, 100.0 * islands.asleepShare(), islands.wakeups));
  add("");
  add(fmt::format("  energy {:.4g} J to {:.4g} J; deepest penetration {}; largest control {}",
                  initialEnergy_, finalEnergy_, millimetres(maxPenetration_),
                  bounded_.empty() ? std::string("without a box")
                                   : fmt::format("{:.0f} % of its box", 100.0 * maxControlRatio_)));
  if (error.estimated)
    add(fmt::format("  error of these settings: {:.2g} m, {:.2g} rad, estimated; {}",
                    error.position, error.orientation,
                    error.ofSteps ? "what the steps err by, added up" : "root mean square"));
  for (const GoalOutcome& goal : goals)
    add(fmt::format("  {:<26}{:>12} -> {:>10} {:>8.0f} %", goal.name,
                    millimetres(goal.initialError), millimetres(goal.finalError),
                    percentNearer(goal)));
  for (const std::string& warning : warnings) add("  warning: " + warning);
  add("");
  add(verdict(outcome, goals));
  return out;
}

std::vector<std::pair<std::string, std::string>> Summary::facts() const {
  std::vector<std::pair<std::string, std::string>> facts = {
      {"verdict", verdict(outcome, goals)},
      {"robot",
       fmt::format("{} links, {} dof, {} actuated, {:.4g} kg", links_, dofs_, actuated_, massKg)},
      {"run", fmt::format("{:.4g} s in {:.3g} s, {:.3g} x real time", simulatedSeconds(),
                          wallSeconds, realTimeFactor())},
      {"steps", fmt::format("{} of {:.4g} ms, {}", steps_, 1e3 * timestep_, integrator)},
      {"effects", fmt::format("{}", fmt::join(effects, " "))},
      {"step", fmt::format("{:.3g} µs, 95 % below {:.3g} µs", stepUs_.percentile(0.5),
                           stepUs_.percentile(0.95))},
      {"physics violation", fmt::format("95 % below {:.2g}", physicsViolation_.percentile(0.95))},
      {"deepest penetration", millimetres(maxPenetration_)}};
  for (const GoalOutcome& goal : goals)
    facts.emplace_back(goal.name, fmt::format("{} to {}", millimetres(goal.initialError),
                                              millimetres(goal.finalError)));
  return facts;
}

}  // namespace softgauss::io

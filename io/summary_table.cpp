// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "softgauss/io/figure_text.hpp"
#include "softgauss/io/summary.hpp"

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

/// As many columns as the longest word takes, so that sentences stand below each other.
std::string verdictText(const std::vector<std::pair<std::string, std::string>>& verdict,
                        const std::string& outcome) {
  if (verdict.empty()) return outcome + "\n";
  std::size_t width = 0;
  for (const auto& [word, sentence] : verdict) width = std::max(width, word.size());
  std::string out;
  for (const auto& [word, sentence] : verdict)
    out += fmt::format("{:<{}}  {}\n", word + ":", width + 1, sentence);
  return out;
}

}  // namespace

std::string Summary::detailsTable() const {
  std::string out;
  const auto add = [&](const std::string& line) { out += line + "\n"; };
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
    add(fmt::format("  goal solves: {:.4g} % certified minima, {:.3g} % of all nonsmooth minima",
                    100.0 * static_cast<double>(gdd.certified + gdd.nonsmoothMinima) / gdd.all(),
                    100.0 * static_cast<double>(gdd.nonsmoothMinima) / gdd.all()));
  if (integration.evaluations > 0)
    add(
        fmt::format("  integration: {} evaluations of the dynamics, {} substeps, {} more tried and "
                    "rejected, {} accepted at the minimum step, {} shortened against tunnelling",
                    integration.evaluations, integration.substeps, integration.rejections,
                    fallbacks.minimumStepsAccepted, integration.tunnellingSplits));
  else if (integration.parts > static_cast<long>(steps_) || integration.repeats > 1)
    add(fmt::format("  integration: {} substeps of {} steps, {} solves repeated", integration.parts,
                    steps_, integration.repeats));
  std::string acts;
  for (const std::size_t m : mechanismsInUse_)
    if (mechanismActs[m] > 0)
      acts += fmt::format("{}{} {}", acts.empty() ? "" : ", ", kMechanismNames[m].name,
                          mechanismActs[m]);
  if (!acts.empty()) add("  mechanisms of the step, how often each acted: " + acts);
  add("");
  return out;
}

std::string Summary::table(bool details) const {
  std::string out;
  const auto add = [&](const std::string& line) { out += line + "\n"; };
  add(fmt::format("{}: {} links, {} dof, {} actuated, {:.4g} kg", modelName_, links_, dofs_,
                  actuated_, massKg));
  add(fmt::format("  {:.4g} s simulated in {:.3g} s, {:.3g} x real time; {} steps of {:.4g} ms, {}",
                  simulatedSeconds(), wallSeconds, realTimeFactor(), steps_, 1e3 * timestep_,
                  integrator));
  if (details) out += detailsTable();
  if (sleep.on)
    add(fmt::format("  sleep: up to {} of {} trees, {:.3g} % of them over the run, {} woken",
                    sleep.most, sleep.trees, 100.0 * sleep.asleepShare(), sleep.wakeups));
  const std::vector<ControlRatio> ratios = controlRatios();
  add(fmt::format("  energy {:.4g} J to {:.4g} J; deepest penetration {}; largest control {}",
                  initialEnergy_, finalEnergy_, lengthText(maxPenetration_),
                  ratios.empty() ? std::string("without limits")
                                 : fmt::format("{:.0f} % of its limit, {}",
                                               100.0 * ratios.front().ratio, ratios.front().name)));
  if (error.estimated)
    add(fmt::format("  error of these settings: {:.2g} m, {:.2g} rad, estimated; {}",
                    error.position, error.orientation,
                    error.ofSteps ? "local errors of the steps, summed" : "root mean square"));
  for (const std::string& warning : warnings) add("  warning: " + warning);
  add("");
  return out + verdictText(verdict, outcome);
}

std::vector<std::pair<std::string, std::string>> Summary::facts() const {
  std::vector<std::pair<std::string, std::string>> facts = verdict;
  if (facts.empty()) facts.emplace_back("", outcome);
  // The page shows the first one by itself.
  facts[0].second = facts[0].first + (facts[0].first.empty() ? "" : ": ") + facts[0].second;
  facts[0].first = "verdict";
  facts.insert(
      facts.end(),
      {{"robot",
        fmt::format("{} links, {} dof, {} actuated, {:.4g} kg", links_, dofs_, actuated_, massKg)},
       {"run", fmt::format("{:.4g} s in {:.3g} s, {:.3g} x real time", simulatedSeconds(),
                           wallSeconds, realTimeFactor())},
       {"steps", fmt::format("{} of {:.4g} ms, {}", steps_, 1e3 * timestep_, integrator)},
       {"effects", fmt::format("{}", fmt::join(effects, " "))},
       {"step", fmt::format("{:.3g} µs, 95 % below {:.3g} µs", stepUs_.percentile(0.5),
                            stepUs_.percentile(0.95))},
       {"physics violation", fmt::format("95 % below {:.2g}", physicsViolation_.percentile(0.95))},
       {"deepest penetration", lengthText(maxPenetration_)}});
  for (const std::string& base : bases) facts.emplace_back("base", base);
  return facts;
}

}  // namespace softgauss::io

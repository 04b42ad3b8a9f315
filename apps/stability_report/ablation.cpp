// SPDX-License-Identifier: Apache-2.0
#include "apps/stability_report/ablation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "apps/stability_report/outcome.hpp"

namespace softgauss::app {
namespace {

/// Bounds that are missed, "case, figure", in the order of the cases.
std::vector<std::string> missedBounds(const std::filesystem::path& scenes,
                                      const std::function<bool(const HardCase&)>& takes,
                                      double timestep, const MechanismSet& mechanisms) {
  std::vector<std::string> missed;
  for (const HardCase& hard : hardCases()) {
    if (!takes(hard)) continue;
    const Outcome outcome = runOurs(scenes, hard, timestep, mechanisms);
    for (std::size_t f = 0; f < hard.figures.size(); ++f)
      if (!outcome.holds(hard, f))
        missed.push_back(fmt::format("{}, {}", hard.title, hard.figures[f].name));
  }
  return missed;
}

/// Mechanisms that are left out together: their row's heading, and the bounds missed more than with
/// all, by step.
struct Row {
  std::vector<MechanismName> without;
  std::vector<std::vector<std::string>> missed;

  bool missesNone() const {
    return std::all_of(missed.begin(), missed.end(), [](const auto& m) { return m.empty(); });
  }
  std::string text() const {
    std::vector<std::string> names;
    for (const MechanismName& m : without) names.push_back(fmt::format("`{}`", m.name));
    std::string row = fmt::format("| {} |", fmt::join(names, ", "));
    for (const auto& m : missed)
      row += m.empty() ? " – |" : fmt::format(" {}: {} |", m.size(), fmt::join(m, "; "));
    return row;
  }
};

/// Sets that single rows do not show: each pair of mechanisms that nothing needs alone, all of
/// these together, and all that there are.
std::vector<std::vector<MechanismName>> furtherSets(const std::vector<Row>& single) {
  std::vector<std::vector<MechanismName>> sets;
  std::vector<MechanismName> idle;
  for (const Row& row : single)
    if (row.missesNone()) idle.push_back(row.without.front());
  for (std::size_t i = 0; i < idle.size(); ++i)
    for (std::size_t j = i + 1; j < idle.size(); ++j) sets.push_back({idle[i], idle[j]});
  if (idle.size() > 2) sets.push_back(idle);
  sets.emplace_back(std::begin(kMechanismNames), std::end(kMechanismNames));
  return sets;
}

}  // namespace

std::string ablate(const std::filesystem::path& scenes,
                   const std::function<bool(const HardCase&)>& takes,
                   const std::function<void(const std::string&)>& told) {
  std::string table;
  const auto add = [&](const std::string& row) {
    told(row);
    table += row + "\n";
  };
  add("| left out | at 2 ms | at 10 ms |\n|---|---|---|");
  std::vector<std::vector<std::string>> withAll;
  std::string row = "| nothing |";
  for (const double timestep : kSteps) {
    withAll.push_back(missedBounds(scenes, takes, timestep, MechanismSet::all()));
    row += fmt::format(" {} missed |", withAll.back().size());
  }
  add(row);
  const auto rowOf = [&](const std::vector<MechanismName>& without) {
    Row r{without, {}};
    MechanismSet others = MechanismSet::all();
    for (const MechanismName& m : without) others.remove(m.mechanism);
    for (std::size_t i = 0; i < std::size(kSteps); ++i) {
      r.missed.emplace_back();
      for (std::string& bound : missedBounds(scenes, takes, kSteps[i], others))
        if (std::find(withAll[i].begin(), withAll[i].end(), bound) == withAll[i].end())
          r.missed.back().push_back(std::move(bound));
    }
    add(r.text());
    return r;
  };
  std::vector<Row> single;
  for (const MechanismName& m : kMechanismNames) single.push_back(rowOf({m}));
  for (const std::vector<MechanismName>& set : furtherSets(single)) rowOf(set);
  return table;
}

}  // namespace softgauss::app

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
  for (const MechanismName& m : kMechanismNames) {
    MechanismSet others = MechanismSet::all();
    others.remove(m.mechanism);
    row = fmt::format("| `{}` |", m.name);
    for (std::size_t i = 0; i < std::size(kSteps); ++i) {
      std::vector<std::string> more;
      for (std::string& bound : missedBounds(scenes, takes, kSteps[i], others))
        if (std::find(withAll[i].begin(), withAll[i].end(), bound) == withAll[i].end())
          more.push_back(std::move(bound));
      row += more.empty() ? " – |" : fmt::format(" {}: {} |", more.size(), fmt::join(more, "; "));
    }
    add(row);
  }
  return table;
}

}  // namespace softgauss::app

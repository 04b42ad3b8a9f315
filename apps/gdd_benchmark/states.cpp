// SPDX-License-Identifier: Apache-2.0
#include "apps/gdd_benchmark/states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace softgauss::app {
namespace {

using Json = nlohmann::ordered_json;

template <class Vector>
Json list(const Vector& x) {
  return std::vector<double>(x.begin(), x.end());
}

const char* statusName(gdd::GddStatus status) {
  switch (status) {
    case gdd::GddStatus::converged:
      return "converged";
    case gdd::GddStatus::nonsmoothMinimum:
      return "kink";
    case gdd::GddStatus::iterationLimit:
      return "iterationLimit";
    case gdd::GddStatus::nonsmoothStall:
      return "bend";
    case gdd::GddStatus::undecided:
      return "undecided";
    case gdd::GddStatus::badLimits:
      return "badBox";
    case gdd::GddStatus::notFinite:
      return "notFinite";
  }
  return "";
}

Json stateOf(const Dataset& dataset, const Record& record) {
  const gdd::Reach& goal = dataset.goals[record.goal];
  return {{"time", record.state.time},
          {"contacts", record.contacts},
          {"status", statusName(record.status)},
          {"goal",
           {{"link", goal.link},
            {"weight", goal.weight},
            {"point", list(goal.p_FP)},
            {"target", list(goal.p_WTarget)}}},
          {"q", list(record.state.q)},
          {"v", list(record.state.v)},
          {"control", list(record.control)},
          {"acceleration", list(record.acceleration)}};
}

}  // namespace

void writeStates(const Robot& robot, const Dataset& dataset, double weight, int count,
                 const std::filesystem::path& folder) {
  std::vector<const Record*> touching;
  for (const Record& record : dataset.records)
    if (record.contacts > 0) touching.push_back(&record);
  const std::size_t size = std::min(touching.size(), static_cast<std::size_t>(count));
  const std::filesystem::path path = folder / fmt::format("{}_{:g}.json", robot.name, weight);
  const Json head = {{"model", robot.name},
                     {"timestep_s", robot.model.options.timestep},
                     {"goal_weight_kg", dataset.weight},
                     {"recorder", dataset.recorder}};
  std::string text = head.dump();
  text.pop_back();
  text += ",\n\"joints\": [";
  for (std::size_t i = 0; i < robot.model.dofs.size(); ++i)
    text +=
        fmt::format("{}\"{}\"", i > 0 ? "," : "", robot.model.jointNames[robot.model.dofs[i].body]);
  text += "],\n\"states\": [\n";
  for (std::size_t i = 0; i < size; ++i)
    text += stateOf(dataset, *touching[(2 * i + 1) * touching.size() / (2 * size)]).dump() +
            (i + 1 < size ? ",\n" : "\n");
  std::ofstream file(path);
  if (!(file << text << "]}\n" << std::flush))
    throw std::runtime_error(path.string() + ": cannot be written");
}

}  // namespace softgauss::app

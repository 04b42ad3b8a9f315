// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/goals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "softgauss/io/detail/goal_kinds.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/scene_parts.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/yaml.hpp"

namespace softgauss::io {
namespace {

using detail::GoalKind;
using detail::goalKinds;
using detail::GoalPointer;
using detail::GoalScene;
using detail::Range;
using detail::YamlMap;
using detail::YamlValue;

/// When the goal acts: from `start` until `end`.
void readTimes(const YamlMap& keys, gdd::Goal& goal) {
  keys.read("start", goal.startTime, Range::any);
  keys.read("end", goal.endTime, Range::any);
  const auto* end = keys.find("end");
  if (end && goal.endTime <= goal.startTime)
    keys.fail(*end, fmt::format("found {} s, expected a time after the start at {} s", goal.endTime,
                                goal.startTime));
}

/// The goal of one item of the list, `kind: {key: value, …}`.
GoalPointer readGoal(const std::string& file, const YamlValue& item, std::size_t number,
                     const GoalScene& scene) {
  const std::string label = fmt::format("goal {}", number);
  std::vector<std::string> names;
  for (const GoalKind& kind : goalKinds()) names.push_back(kind.name);
  if (item.kind != YamlValue::Kind::map)
    throw ModelError({file, item.line}, label,
                     fmt::format("found {}, expected kind: {{…}}, the kind one of {}",
                                 item.described(), detail::listed(names)));
  const YamlMap kinds(file, label + ": ", "", item);
  if (kinds.entries().size() != 1) {
    std::vector<std::string> found;
    for (const YamlMap::Entry& entry : kinds.entries()) found.push_back(entry.key);
    throw ModelError(
        {file, item.line}, label,
        fmt::format("found {} ({}), expected one, the kind, whose own keys are in {{…}} "
                    "or indented below it",
                    detail::counted(found.size(), "key"), detail::listed(found)));
  }
  const YamlMap::Entry& only = kinds.entries().front();
  const auto kind = std::find_if(goalKinds().begin(), goalKinds().end(),
                                 [&](const GoalKind& k) { return k.name == only.key; });
  if (kind == goalKinds().end())
    throw ModelError(
        {file, only.line}, label,
        fmt::format("found the unknown kind {}, expected one of {}{}", detail::quotedText(only.key),
                    detail::listed(names), detail::suggestion(only.key, names)));
  const std::string named = fmt::format("{} '{}'", label, kind->name);
  if (only.value.kind != YamlValue::Kind::map)
    throw ModelError({file, only.line}, named,
                     fmt::format("found {}, expected a map {{…}} with keys of {}",
                                 only.value.described(), detail::listed(kind->keys)));
  const YamlMap keys(file, named + ": ", "", only.value);
  std::vector<std::string> known = kind->keys;
  known.insert(known.end(), {"start", "end"});
  keys.expectOnly(known);
  GoalPointer goal = kind->read(keys, scene);
  readTimes(keys, *goal);
  return goal;
}

}  // namespace

void GoalFile::giveTo(gdd::GoalDirectedController& controller) && {
  controller.goals = std::move(goals);
  if (controlCost) controller.controlCost = *controlCost;
}

GoalFile readGoalFile(const std::filesystem::path& file, const Model& model, const State& initial,
                      const DistancesMaker& distances) {
  const std::string path = file.string();
  return parseGoals(detail::readInput(path, "a YAML file of goals"), detail::inputName(path), model,
                    initial, distances);
}

GoalFile parseGoals(const std::string& text, const std::string& name, const Model& model,
                    const State& initial, const DistancesMaker& distances) {
  SOFTGAUSS_ASSERT(initial.q.size() == model.nq);
  const YamlValue root = detail::parseYaml(name, text, "goals: [...]");
  if (root.kind != YamlValue::Kind::map)
    throw ModelError({name, root.line}, "file",
                     fmt::format("found {}, expected goals: [...]", root.described()));
  const YamlMap top(name, "", "", root);
  // A scene file may hold goals too.
  const bool isScene = top.find("robots") || top.find("objects");
  top.expectOnly(isScene ? detail::kSceneKeys : std::vector<std::string>{"goals", "control_cost"});
  const YamlMap::Entry& list = top.required("goals", "a list of goals");
  if (list.value.items.empty())
    top.fail(list,
             fmt::format("found {}, expected a list of at least one goal", list.value.described()));

  GoalFile result;
  for (const YamlValue& item : list.value.items)
    result.goals.push_back(
        readGoal(top.file(), item, result.goals.size() + 1, {model, initial, distances}));
  detail::joinLines(result.goals);
  if (const YamlMap::Entry* cost = top.find("control_cost"))
    result.controlCost = top.choice(*cost, {"about_gravity", "total"}) == "total"
                             ? gdd::ControlCost::total
                             : gdd::ControlCost::aboutGravity;
  return result;
}

std::vector<std::unique_ptr<gdd::Goal>> readGoals(const std::filesystem::path& file,
                                                  const Model& model, const State& initial,
                                                  const DistancesMaker& distances) {
  return readGoalFile(file, model, initial, distances).goals;
}

}  // namespace softgauss::io

// SPDX-License-Identifier: Apache-2.0
#include "io/goals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "engine/dynamics/kinematics.hpp"
#include "gdd/goals/posture.hpp"
#include "gdd/goals/reach.hpp"
#include "gdd/goals/virtual_damping.hpp"
#include "io/detail/text.hpp"
#include "io/detail/yaml.hpp"

namespace softgauss::io {
namespace {

using detail::Range;
using detail::YamlMap;
using detail::YamlValue;

// ---- One function for each kind of goal ---------------------------------------------------------

using GoalPointer = std::unique_ptr<gdd::Goal>;

/// What the goals are about.
struct Scene {
  const Model& model;
  const State& initial;
};

/// The link that the entry names; it must move.
std::string movingLink(const YamlMap& keys, const YamlMap::Entry& entry, const Model& model) {
  const std::string link = keys.name(entry);
  std::vector<std::string> links;
  for (const Frame& frame : model.frames)
    if (frame.body != 0) links.push_back(frame.name);
  const int frame = model.findFrame(link);
  if (frame < 0)
    keys.fail(entry,
              fmt::format("found {}, expected a link of model '{}'{}", detail::quotedText(link),
                          model.name, detail::suggestion(link, links)));
  if (model.frames[static_cast<std::size_t>(frame)].body == 0)
    keys.fail(entry,
              fmt::format("found {}, which is fixed to the world, expected a link that moves",
                          detail::quotedText(link)));
  return link;
}

/// The line of Flash and Hogan from where the goal's point is at first.
gdd::MinimumJerk readMinimumJerk(const YamlMap& keys, const gdd::Reach& goal, const Scene& scene) {
  keys.expectOnly({"duration", "start"});
  gdd::MinimumJerk line;
  keys.read("duration", line.duration, Range::positive);
  keys.read("start", line.startTime, Range::any);
  Kinematics kinematics(scene.model);
  computeKinematics(scene.model, scene.initial, kinematics);
  line.p_start = framePose(scene.model, kinematics, goal.frame) * goal.p_FP;
  return line;
}

GoalPointer readReach(const YamlMap& keys, const Scene& scene) {
  const std::string link =
      movingLink(keys, keys.required("link", "the name of a link"), scene.model);
  const Vector3 target = keys.vector3(keys.required("target", "three numbers [x, y, z]"));
  auto goal = std::make_unique<gdd::Reach>(scene.model, link, target);
  if (const auto* point = keys.find("point")) goal->p_FP = keys.vector3(*point);
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  if (const auto* line = keys.find("minimum_jerk"))
    goal->minimumJerk = readMinimumJerk(keys.map(*line), *goal, scene);
  return goal;
}

/// Replaces the positions of the joints that the map names.
void readJoints(const YamlMap& joints, const Model& model, VectorX& q) {
  std::vector<std::string> names;
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[static_cast<std::size_t>(b)].dofs == 1)
      names.push_back(model.jointNames[static_cast<std::size_t>(b)]);

  for (const YamlMap::Entry& entry : joints.entries()) {
    const int body = model.findJoint(entry.key);
    if (body < 0)
      joints.fail(entry, fmt::format("found an unknown joint, expected one of model '{}'{}",
                                     model.name, detail::suggestion(entry.key, names)));
    const Body& carried = model.bodies[static_cast<std::size_t>(body)];
    if (carried.dofs != 1)
      joints.fail(entry, fmt::format("found a joint of {} degrees of freedom, expected a revolute, "
                                     "continuous or prismatic one",
                                     carried.dofs));
    q[carried.q] = joints.number(entry);
  }
}

GoalPointer readPosture(const YamlMap& keys, const Scene& scene) {
  auto goal = std::make_unique<gdd::Posture>(scene.initial.q);
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  if (const auto* joints = keys.find("joints")) readJoints(keys.map(*joints), scene.model, goal->q);
  return goal;
}

GoalPointer readDamping(const YamlMap& keys, const Scene&) {
  auto goal = std::make_unique<gdd::VirtualDamping>();
  keys.read("weight", goal->weight, Range::notNegative);
  keys.read("rate", goal->rate, Range::notNegative);
  return goal;
}

struct GoalKind {
  std::string name;
  std::vector<std::string> keys;
  GoalPointer (*read)(const YamlMap& keys, const Scene& scene);
};

/// To add a kind of goal: write its function above, name it and its keys here, and show it in
/// docs/goals.md.
const std::vector<GoalKind>& goalKinds() {
  static const std::vector<GoalKind> kinds = {
      {"reach",
       {"link", "target", "point", "weight", "stiffness", "damping", "minimum_jerk"},
       readReach},
      {"posture", {"weight", "stiffness", "damping", "joints"}, readPosture},
      {"damping", {"weight", "rate"}, readDamping},
  };
  return kinds;
}

// ---- The file -----------------------------------------------------------------------------------

/// The goal of one item of the list, `kind: {key: value, …}`.
GoalPointer readGoal(const std::string& file, const YamlValue& item, std::size_t number,
                     const Scene& scene) {
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
  keys.expectOnly(kind->keys);
  return kind->read(keys, scene);
}

}  // namespace

std::vector<std::unique_ptr<gdd::Goal>> readGoals(const std::filesystem::path& file,
                                                  const Model& model, const State& initial) {
  SOFTGAUSS_ASSERT(initial.q.size() == model.nq);
  const std::string path = file.string();
  const std::optional<std::string> text = detail::readFile(path);
  if (!text) throw ModelError({path, 0}, "file", "cannot be read, expected a YAML file of goals");
  const YamlValue root = detail::parseYaml(path, *text, "goals: [...]");
  if (root.kind != YamlValue::Kind::map)
    throw ModelError({path, root.line}, "file",
                     fmt::format("found {}, expected goals: [...]", root.described()));
  const YamlMap top(path, "", "", root);
  // A scene file, whose other keys readScene() knows, may hold goals too.
  if (!top.find("robots") && !top.find("objects")) top.expectOnly({"goals"});
  const YamlMap::Entry& list = top.required("goals", "a list of goals");
  if (list.value.items.empty())
    top.fail(list,
             fmt::format("found {}, expected a list of at least one goal", list.value.described()));

  std::vector<std::unique_ptr<gdd::Goal>> goals;
  for (const YamlValue& item : list.value.items)
    goals.push_back(readGoal(path, item, goals.size() + 1, {model, initial}));
  return goals;
}

}  // namespace softgauss::io

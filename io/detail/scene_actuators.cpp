// SPDX-License-Identifier: Apache-2.0
#include "io/detail/scene_actuators.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

/// `joints: {name: coefficient, …}`
void readJoints(const YamlMap& map, ModelBuilder& builder, SceneActuator& actuator) {
  const YamlMap joints =
      map.map(map.required("joints", "a map {joint: coefficient} of what it drives"));
  if (joints.entries().empty())
    map.fail(*map.find("joints"), "found no joint, expected {joint: coefficient, …}");
  for (const YamlMap::Entry& entry : joints.entries()) {
    JointSpec* joint = builder.findJoint(entry.key);
    const bool scalar =
        joint && (joint->type == JointType::revolute || joint->type == JointType::continuous ||
                  joint->type == JointType::prismatic);
    if (!scalar)
      joints.fail(entry, "found no joint of one degree of freedom of that name in the scene");
    if (joint->mimic)
      joints.fail(entry, fmt::format("found a joint that mimics '{}', expected one with a force of "
                                     "its own",
                                     joint->mimic->leader));
    const double coefficient = joints.number(entry);
    if (coefficient == 0.0) joints.fail(entry, "found 0, expected a number other than 0");
    actuator.joints.emplace_back(entry.key, coefficient);
    joint->effort.reset();
  }
}

/// `bounds: [lower, upper]`
void readBounds(const YamlMap& map, const YamlMap::Entry& entry, SceneActuator& actuator) {
  const std::vector<YamlValue>& items = map.list(entry);
  const auto number = [&](std::size_t i) {
    const std::optional<double> x =
        items.size() == 2 ? items[i].finiteNumber() : std::optional<double>();
    if (!x)
      map.fail(entry, fmt::format("found {}, expected two finite numbers [lower, upper]",
                                  entry.value.described()));
    return *x;
  };
  actuator.lower = number(0);
  actuator.upper = number(1);
  if (!(actuator.lower <= actuator.upper))
    map.fail(entry, fmt::format("found the lower bound {:g} above the upper one {:g}",
                                actuator.lower, actuator.upper));
}

}  // namespace

SceneActuator readActuator(const YamlMap& map, ModelBuilder& builder,
                           std::set<std::string>& names) {
  map.expectOnly({"name", "joints", "effort", "bounds"});
  SceneActuator actuator;
  actuator.where = {map.file(), map.line()};
  const YamlMap::Entry& name = map.required("name", "a name of its own");
  actuator.name = map.name(name);
  if (!names.insert(actuator.name).second)
    map.fail(name, fmt::format("found {} a second time, expected a name of its own",
                               quotedText(actuator.name)));
  readJoints(map, builder, actuator);
  const YamlMap::Entry* effort = map.find("effort");
  if (const auto* bounds = map.find("bounds")) {
    if (effort)
      map.fail(*effort,
               fmt::format("found beside bounds in line {}, expected one of them", bounds->line));
    readBounds(map, *bounds, actuator);
  } else if (effort) {
    actuator.upper = map.number(*effort, Range::notNegative);
    actuator.lower = -actuator.upper;
  }
  return actuator;
}

void expectIndependent(const std::vector<SceneActuator>& actuators) {
  std::vector<std::string> joints;
  std::vector<gdd::Actuator> list;
  for (const SceneActuator& actuator : actuators) {
    gdd::Actuator& out = list.emplace_back();
    out.name = actuator.name;
    out.where = actuator.where;
    for (const auto& [joint, coefficient] : actuator.joints) {
      const auto known = std::find(joints.begin(), joints.end(), joint);
      out.pulls.push_back({static_cast<int>(known - joints.begin()), coefficient});
      if (known == joints.end()) joints.push_back(joint);
    }
  }
  gdd::Transmission(static_cast<int>(joints.size()), std::move(list));
}

}  // namespace softgauss::io::detail

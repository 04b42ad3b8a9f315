// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/scene_actuators.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

/// `joints: {name: coefficient, …}`
void readJoints(const YamlMap& map, const std::set<std::string>& known, ModelBuilder& builder,
                SceneActuator& actuator) {
  const YamlMap joints =
      map.map(map.required("joints", "a map {joint: coefficient} of what it drives"));
  if (joints.entries().empty())
    map.fail(*map.find("joints"), "found no joint, expected {joint: coefficient, …}");
  for (const YamlMap::Entry& entry : joints.entries()) {
    if (known.count(entry.key) == 0)
      joints.fail(entry, "found no joint of one degree of freedom of that name in the scene" +
                             offered(entry.key, {known.begin(), known.end()}));
    JointSpec* joint = builder.findJoint(entry.key);
    if (joint->mimic)
      joints.fail(entry, fmt::format("found a joint that mimics '{}', expected one with a force of "
                                     "its own",
                                     joint->mimic->leader));
    const double coefficient = joints.number(entry, Range::notZero);
    actuator.joints.emplace_back(entry.key, coefficient);
    joint->effort.reset();
  }
}

/// `bounds: [lower, upper]`
void readBounds(const YamlMap& map, const YamlMap::Entry& entry, SceneActuator& actuator) {
  const std::vector<double> bounds = map.numbers(entry, 2, 2, "two finite numbers [lower, upper]");
  actuator.lower = bounds[0];
  actuator.upper = bounds[1];
  if (!(actuator.lower <= actuator.upper))
    map.fail(entry, fmt::format("found the lower bound {:g} above the upper one {:g}",
                                actuator.lower, actuator.upper));
}

}  // namespace

SceneActuator readActuator(const YamlMap& map, const std::set<std::string>& joints,
                           ModelBuilder& builder, std::set<std::string>& names) {
  map.expectOnly({"name", "joints", "effort", "bounds"});
  SceneActuator actuator;
  actuator.where = {map.file(), map.line()};
  const YamlMap::Entry& name = map.required("name", "a name of its own");
  actuator.name = map.name(name);
  if (!names.insert(actuator.name).second)
    map.fail(name, fmt::format("found {} a second time, expected a name of its own",
                               quotedText(actuator.name)));
  readJoints(map, joints, builder, actuator);
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

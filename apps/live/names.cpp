// SPDX-License-Identifier: Apache-2.0
#include "apps/live/names.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/engine/model/plan.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::live {
namespace {

/// Effects of forces that an element of the model calls for. Contacts, connections and armature are
/// not among them: what touches and how soft it is were found when the scene was loaded.
std::vector<std::string> switchable(const Model& model) {
  const Plan plan(model);
  std::vector<std::string> names;
  for (const Effect effect : {Effect::gravity, Effect::coriolis, Effect::damping, Effect::spring,
                              Effect::jointLimit, Effect::dryFriction})
    if (plan.effects.has(effect)) names.emplace_back(effectName(effect));
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

Names::Names(const Model& model, const std::vector<std::unique_ptr<gdd::Goal>>& all)
    : modelName(model.name), goals(gdd::distinctNames(all)), effects(switchable(model)) {
  for (const Frame& frame : model.frames)
    if (frame.body != 0) links.push_back(frame.name);
  for (int b = 1; b < model.bodyCount(); ++b) {
    const JointKind kind = model.bodies[b].joint;
    if (kind != JointKind::revolute && kind != JointKind::prismatic) continue;
    JointName joint{model.jointNames[b], b, -kInfinity, kInfinity, kind == JointKind::revolute};
    for (const JointRange& range : model.ranges)
      if (range.body == b) joint.lower = range.lower, joint.upper = range.upper;
    joints.push_back(joint);
  }
}

std::string Names::problem(FieldKind kind, const std::string& name) const {
  std::vector<std::string> jointNames;
  const std::vector<std::string>* known = nullptr;
  switch (kind) {
    case FieldKind::link:
      known = &links;
      break;
    case FieldKind::goal:
      known = &goals;
      break;
    case FieldKind::effect:
      known = &effects;
      break;
    case FieldKind::state:
      known = &states;
      break;
    case FieldKind::joint:
      for (const JointName& joint : joints) jointNames.push_back(joint.name);
      known = &jointNames;
      break;
    default:
      return "";
  }
  if (contains(*known, name)) return "";
  return fmt::format("found {}, expected {}{}", io::detail::quotedText(name),
                     expectedOf({"", kind, true, 0, 0, ""}), io::detail::offered(name, *known));
}

int Names::goal(const std::string& name) const {
  return static_cast<int>(std::find(goals.begin(), goals.end(), name) - goals.begin());
}

const JointName& Names::joint(const std::string& name) const {
  return *std::find_if(joints.begin(), joints.end(),
                       [&](const JointName& joint) { return joint.name == name; });
}

std::string problemOf(const Event& event, const Names& names) {
  const EventType& type = typeOf(event.kind);
  for (const Field& field : type.fields) {
    const FieldValue* value = event.find(field.name);
    std::string problem;
    if (value)
      problem = problemOf(field, *value);
    else if (field.required)
      problem = "is missing, expected " + expectedOf(field);
    if (value && problem.empty())
      if (const auto* text = std::get_if<std::string>(value))
        problem = names.problem(field.kind, *text);
    if (!problem.empty()) return fmt::format("{}: '{}': {}", type.name, field.name, problem);
  }
  if (event.kind == EventKind::joint) {
    const JointName& joint = names.joint(event.text("joint"));
    const double position = event.number("position");
    if (position < joint.lower || position > joint.upper)
      return fmt::format(
          "joint: 'position': found {:g}, expected a place in the range {:g} to {:g}", position,
          joint.lower, joint.upper);
  }
  return "";
}

}  // namespace softgauss::live

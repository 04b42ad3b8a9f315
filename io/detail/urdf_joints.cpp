// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/urdf_joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/yaml.hpp"

namespace softgauss::io::detail {
namespace {

constexpr std::pair<const char*, JointType> kJointTypes[] = {
    {"fixed", JointType::fixed},           {"revolute", JointType::revolute},
    {"continuous", JointType::continuous}, {"prismatic", JointType::prismatic},
    {"floating", JointType::floating},     {"planar", JointType::planar},
};

JointType readType(const XmlElement& joint) {
  const std::string text = joint.requiredText("type");
  std::vector<std::string> names;
  for (const auto& [name, type] : kJointTypes) {
    if (text == name) return type;
    names.emplace_back(name);
  }
  joint.fail(fmt::format("unknown type {}, expected one of {}{}", quotedText(text), listed(names),
                         suggestion(text, names)));
}

/// Joints of a kind worth one warning each kind.
struct Notes {
  std::vector<std::string> noRange, halfRange, unusedRange, unusedDynamics, fixedMimics,
      negativeVelocity, zeroVelocity, noEffort, unmovedMimics;

  void appendTo(std::vector<std::string>& warnings) const {
    const auto add = [&](const std::vector<std::string>& joints, const char* text) {
      if (!joints.empty()) warnings.push_back(text + listed(joints));
    };
    add(noRange, "no lower and upper limit, so these joints move without a range: ");
    add(halfRange, "one end of the range is not written and taken as 0: ");
    add(unusedRange, "a range has no meaning on a continuous, planar or floating joint, ignored: ");
    add(unusedDynamics, "damping and friction of a floating joint are ignored: ");
    add(fixedMimics, "mimic of a fixed joint is ignored: ");
    add(negativeVelocity, "a negative velocity limit is taken as none: ");
    add(zeroVelocity, "a velocity limit of 0 is taken as none: ");
    add(noEffort, "no effort in <limit>, so the controls of these joints have no bound: ");
    add(unmovedMimics,
        "mimic with multiplier 0, so these joints are held at their offset, whatever their leader "
        "does: ");
  }
};

bool isScalar(JointType type) {
  return type == JointType::revolute || type == JointType::continuous ||
         type == JointType::prismatic;
}

void readLimit(const XmlElement& limit, JointSpec& joint, Notes& notes) {
  const bool takesRange = joint.type == JointType::revolute || joint.type == JointType::prismatic;
  std::optional<double> lower, upper;
  if (limit) {
    lower = limit.number("lower", XmlElement::Size::any);
    upper = limit.number("upper", XmlElement::Size::any);
    joint.effort = limit.number("effort", XmlElement::Size::any);
    joint.velocity = limit.number("velocity", XmlElement::Size::any);
    if (joint.velocity == 0.0 && isScalar(joint.type)) notes.zeroVelocity.push_back(joint.name);
    if (joint.velocity.value_or(0.0) < 0.0) {
      notes.negativeVelocity.push_back(
          fmt::format("{} ({})", joint.name, shortNumber(*joint.velocity)));
      joint.velocity.reset();
    }
  }
  if (!takesRange) {
    if (joint.type != JointType::fixed && lower.value_or(0.0) != upper.value_or(0.0))
      notes.unusedRange.push_back(joint.name);
    return;
  }
  if (!lower && !upper) {
    notes.noRange.push_back(joint.name);
    return;
  }
  if (!lower || !upper) notes.halfRange.push_back(joint.name);
  joint.lower = lower.value_or(0.0);
  joint.upper = upper.value_or(0.0);
  if (*joint.lower > *joint.upper)
    limit.fail(fmt::format("lower {}{} > upper {}{}, expected lower <= upper",
                           shortNumber(*joint.lower), lower ? "" : " (not written)",
                           shortNumber(*joint.upper), upper ? "" : " (not written)"));
}

void readDynamics(const XmlElement& dynamics, JointSpec& joint, Notes& notes) {
  if (!dynamics) return;
  joint.damping = dynamics.number("damping").value_or(0.0);
  joint.dryFriction = dynamics.number("friction").value_or(0.0);
  if (joint.type == JointType::floating && (joint.damping != 0.0 || joint.dryFriction != 0.0))
    notes.unusedDynamics.push_back(joint.name);
}

void readMimic(const XmlElement& mimic, JointSpec& joint, Notes& notes) {
  if (!mimic) return;
  MimicSpec spec;
  spec.leader = mimic.requiredText("joint");
  spec.multiplier = mimic.number("multiplier").value_or(1.0);
  spec.offset = mimic.number("offset").value_or(0.0);
  if (joint.type == JointType::fixed) {
    notes.fixedMimics.push_back(joint.name);
    return;
  }
  if (!isScalar(joint.type))
    mimic.fail("is on a planar or floating joint, expected revolute, continuous or prismatic");
  if (spec.leader == joint.name) mimic.fail("a joint cannot mimic itself");
  if (spec.multiplier == 0.0) notes.unmovedMimics.push_back(joint.name);
  joint.mimic = spec;
}

using Names = std::unordered_set<std::string>;

/// ", did you mean 'x'?" among some of many names.
std::string suggestionOf(const std::string& name, const Names& names) {
  constexpr std::size_t kMostCompared = 10000;
  if (names.size() > kMostCompared) return {};
  std::vector<std::string> sorted(names.begin(), names.end());
  std::sort(sorted.begin(), sorted.end());
  return suggestion(name, sorted);
}

std::string readLinkName(const XmlElement& end, const Names& links) {
  const std::string name = end.requiredText("link");
  if (!links.count(name))
    end.fail(fmt::format("link {} does not exist{}", quotedText(name), suggestionOf(name, links)));
  return name;
}

JointSpec readJoint(const XmlElement& unnamed, const Names& links, Notes& notes) {
  JointSpec joint;
  joint.name = unnamed.named("joint").requiredText("name");
  const XmlElement element = unnamed.named("joint " + quotedText(joint.name));
  joint.where = element.where();
  joint.type = readType(element);
  joint.parent = readLinkName(element.requiredChild("parent"), links);
  joint.child = readLinkName(element.requiredChild("child"), links);
  joint.X_PC = element.origin();
  if (joint.type != JointType::fixed && joint.type != JointType::floating) {
    if (const XmlElement axis = element.child("axis")) {
      joint.axis = axis.requiredVector3("xyz");
      if (joint.axis.norm() == 0.0) axis.fail("xyz is zero, expected a direction");
    }
  }
  const XmlElement limit = element.child("limit");
  readLimit(limit, joint, notes);
  readDynamics(element.child("dynamics"), joint, notes);
  readMimic(element.child("mimic"), joint, notes);
  if (limit && !joint.effort && isScalar(joint.type) && !joint.mimic)
    notes.noEffort.push_back(joint.name);
  return joint;
}

/// Followers and leaders are scalar joints of this file.
void checkMimics(const XmlElement& robot, const std::vector<JointSpec>& joints) {
  Names leaders;
  for (const JointSpec& joint : joints)
    if (isScalar(joint.type)) leaders.insert(joint.name);
  const std::vector<XmlElement> elements = robot.children("joint");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].mimic) continue;
    const std::string& leader = joints[i].mimic->leader;
    if (leaders.count(leader)) continue;
    elements[i]
        .named("joint " + quotedText(joints[i].name))
        .child("mimic")
        .fail(fmt::format("joint {} is not a revolute, continuous or prismatic joint of this "
                          "robot{}",
                          quotedText(leader), suggestionOf(leader, leaders)));
  }
}

}  // namespace

std::vector<JointSpec> readJoints(const XmlElement& robot, const std::vector<std::string>& links,
                                  std::vector<std::string>& warnings) {
  Notes notes;
  std::vector<JointSpec> joints;
  const Names names(links.begin(), links.end());
  for (const XmlElement& joint : robot.children("joint"))
    joints.push_back(readJoint(joint, names, notes));
  checkMimics(robot, joints);
  notes.appendTo(warnings);
  return joints;
}

}  // namespace softgauss::io::detail

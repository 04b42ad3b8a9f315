// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/urdf_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

struct KnownElement {
  std::string_view tag;
  std::vector<std::string_view> children;
  std::vector<std::string_view> attributes;
};

const std::vector<KnownElement>& knownElements() {
  static const std::vector<KnownElement> known = {
      {"robot", {"link", "joint", "material"}, {"name", "version"}},
      {"link", {"inertial", "collision", "visual"}, {"name"}},
      {"inertial", {"origin", "mass", "inertia"}, {}},
      {"mass", {}, {"value"}},
      {"inertia", {}, {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}},
      {"origin", {}, {"xyz", "rpy", "quat_xyzw"}},
      {"collision", {"origin", "geometry"}, {"name"}},
      {"visual", {"origin", "geometry", "material"}, {"name"}},
      {"geometry", {"box", "sphere", "cylinder", "capsule", "mesh"}, {}},
      {"box", {}, {"size"}},
      {"sphere", {}, {"radius"}},
      {"cylinder", {}, {"radius", "length"}},
      {"capsule", {}, {"radius", "length"}},
      {"mesh", {}, {"filename", "scale"}},
      {"material", {"color", "texture"}, {"name"}},
      {"color", {}, {"rgba"}},
      {"texture", {}, {"filename"}},
      {"joint",
       {"parent", "child", "origin", "axis", "limit", "dynamics", "mimic"},
       {"name", "type"}},
      {"parent", {}, {"link"}},
      {"child", {}, {"link"}},
      {"axis", {}, {"xyz"}},
      {"limit", {}, {"lower", "upper", "effort", "velocity"}},
      {"dynamics", {}, {"damping", "friction"}},
      {"mimic", {}, {"joint", "multiplier", "offset"}},
  };
  return known;
}

/// What <gazebo> says of physics, but for mu1 and mu2, which are read.
const std::vector<std::string_view> kGazeboPhysics = {"kp",
                                                      "kd",
                                                      "dampingFactor",
                                                      "maxVel",
                                                      "minDepth",
                                                      "maxContacts",
                                                      "selfCollide",
                                                      "self_collide",
                                                      "gravity",
                                                      "turnGravityOff",
                                                      "static",
                                                      "springStiffness",
                                                      "springReference",
                                                      "implicitSpringDamper",
                                                      "stopCfm",
                                                      "stopErp",
                                                      "fudgeFactor",
                                                      "cfmDamping",
                                                      "disableFixedJointLumping",
                                                      "preserveFixedJoint",
                                                      "provideFeedback"};

const KnownElement* findElement(std::string_view tag) {
  for (const KnownElement& known : knownElements())
    if (known.tag == tag) return &known;
  return nullptr;
}

bool contains(const std::vector<std::string_view>& list, std::string_view item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

/// Whether an attribute is part of a pose that is not zero.
bool movesSomething(const XmlElement& element, const std::string& name) {
  const std::string zero = name == "quat_xyzw" ? "0 0 0 1" : "0 0 0";
  return contains(findElement("origin")->attributes, name) &&
         parseNumbers(element.text(name.c_str()).value_or("")) != parseNumbers(zero);
}

[[noreturn]] void refusePose(const XmlElement& element, const std::string& name) {
  element.fail(
      fmt::format("attribute '{}' is not read here; expected <origin xyz=… rpy=…/> in "
                  "<joint>, <inertial> or <collision>",
                  name));
}

/// Refuses a pose where none is read: what it moves would stand otherwise. Not in a visual.
void collect(const XmlElement& element, bool isVisual, std::map<std::string, int>& counts) {
  const KnownElement* known = findElement(element.tag());
  // A name or a colour in an unusual place changes nothing worth a warning.
  for (const std::string& name : element.attributes()) {
    if (contains(known->attributes, name) || name == "name" || name.starts_with("xmlns")) continue;
    if (!isVisual && movesSomething(element, name)) refusePose(element, name);
    ++counts[fmt::format("attribute '{}' of <{}>", name, element.tag())];
  }
  for (const XmlElement& child : element.children()) {
    if (contains(known->children, child.tag())) {
      collect(child, isVisual || child.tag() == "visual", counts);
      continue;
    }
    if (child.tag() == "origin" && !isVisual)
      for (const std::string& name : child.attributes())
        if (movesSomething(child, name)) refusePose(child, name);
    if (child.tag() != "material") ++counts[fmt::format("<{}>", child.tag())];
  }
}

}  // namespace

bool isReadElement(std::string_view parent, std::string_view child) {
  const KnownElement* known = findElement(parent);
  return known && contains(known->children, child);
}

bool isReadAttribute(std::string_view tag, std::string_view attribute) {
  const KnownElement* known = findElement(tag);
  return known && contains(known->attributes, attribute);
}

std::vector<std::string> ignoredParts(const XmlElement& robot) {
  std::map<std::string, int> counts;
  collect(robot, false, counts);
  std::vector<std::string> parts, physics;
  bool readsFriction = false;
  for (const XmlElement& gazebo : robot.children("gazebo"))
    for (const XmlElement& child : gazebo.children()) {
      const std::string tag = child.tag();
      readsFriction |= tag == "mu1" || tag == "mu2";
      if (contains(kGazeboPhysics, tag) &&
          std::find(physics.begin(), physics.end(), tag) == physics.end())
        physics.push_back(tag);
    }
  for (const auto& [part, count] : counts) {
    parts.push_back(fmt::format("{} {}", count, part));
    if (part != "<gazebo>") continue;
    if (readsFriction) parts.back() += " but for mu1 and mu2";
    if (!physics.empty())
      parts.back() += fmt::format(" (of its physics {})", listed(physics, physics.size()));
  }
  return parts;
}

}  // namespace softgauss::io::detail

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/urdf_check.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <tinyxml2.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>

#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/urdf_schema.hpp"

namespace softgauss::io::detail {
namespace {

/// Keeps urdfdom's messages off the console while it lives, and collects its errors.
/// console_bridge has one handler for the process, so there is one Listener at a time.
class Listener : public console_bridge::OutputHandler {
 public:
  Listener() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~Listener() override { console_bridge::restorePreviousOutputHandler(); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    if (!errors.empty()) errors += "; ";
    errors += text;
  }

  std::string errors;

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;
};

void setDefault(tinyxml2::XMLElement& element, const char* attribute) {
  if (!element.Attribute(attribute)) element.SetAttribute(attribute, "0");
}

/// A text that may look like numbers and is none.
bool isName(std::string_view attribute) {
  return attribute == "name" || attribute == "link" || attribute == "joint" ||
         attribute == "filename" || attribute == "version";
}

/// urdfdom takes a single space between numbers and nothing else, neither a tab nor a last blank.
std::string bySingleSpaces(const tinyxml2::XMLAttribute& attribute) {
  const std::string value = attribute.Value();
  const std::optional<std::vector<double>> numbers = parseNumbers(value);
  if (!numbers || numbers->empty() || isName(attribute.Name())) return value;
  std::string single;
  for (const std::string_view word : words(value)) {
    if (!single.empty()) single += ' ';
    single += word;
  }
  return single;
}

/// Copies what is read of an element, but for what is only looked at.
void copyRead(const tinyxml2::XMLElement& from, tinyxml2::XMLElement& to) {
  for (const tinyxml2::XMLAttribute* a = from.FirstAttribute(); a; a = a->Next())
    if (isReadAttribute(from.Name(), a->Name()))
      to.SetAttribute(a->Name(), bySingleSpaces(*a).c_str());
  for (const tinyxml2::XMLElement* e = from.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string_view tag = e->Name();
    if (isReadElement(from.Name(), tag) && tag != "visual" && tag != "material")
      copyRead(*e, *to.InsertNewChildElement(e->Name()));
  }
}

/// Roll, pitch and yaw [rad] of R. Roll is that which is left beside yaw: at a pitch of ±π/2, where
/// only their sum counts, it is right too.
Vector3 rollPitchYaw(const Matrix3& R) {
  const double yaw = std::atan2(R(1, 0), R(0, 0)), s = std::sin(yaw), c = std::cos(yaw);
  return {std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1)),
          std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))), yaw};
}

/// The linked urdfdom may know version 1.0 alone: what 1.1 and 1.2 add is written as 1.0 has it.
void writeAsVersion10(tinyxml2::XMLElement& element) {
  const std::string_view tag = element.Name();
  if (const char* quaternion = element.Attribute("quat_xyzw"); quaternion && tag == "origin") {
    const std::vector<double> q = parseNumbers(quaternion).value();
    const Vector3 rpy =
        rollPitchYaw(Quaternion(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix());
    element.DeleteAttribute("quat_xyzw");
    element.SetAttribute("rpy",
                         fmt::format("{:.17g} {:.17g} {:.17g}", rpy.x(), rpy.y(), rpy.z()).c_str());
  }
  if (tag == "capsule") element.SetName("cylinder");
  for (tinyxml2::XMLElement* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement())
    writeAsVersion10(*child);
}

void addWhatUrdfdomDemands(tinyxml2::XMLElement& robot) {
  for (tinyxml2::XMLElement* joint = robot.FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    const std::string_view type = joint->Attribute("type");
    tinyxml2::XMLElement* limit = joint->FirstChildElement("limit");
    if (!limit && (type == "revolute" || type == "prismatic"))
      limit = joint->InsertNewChildElement("limit");
    if (limit) {
      setDefault(*limit, "effort");
      setDefault(*limit, "velocity");
      // As it is read: a negative limit is none.
      if (limit->DoubleAttribute("velocity") < 0.0) limit->SetAttribute("velocity", "0");
    }
    if (tinyxml2::XMLElement* dynamics = joint->FirstChildElement("dynamics"))
      setDefault(*dynamics, "damping");
  }
}

/// What urdfdom sees.
std::string copyFor10(const XmlFile& file) {
  tinyxml2::XMLDocument copy;
  tinyxml2::XMLElement& robot = *copy.NewElement("robot");
  copy.InsertEndChild(&robot);
  copyRead(file.root(), robot);
  robot.DeleteAttribute("version");
  writeAsVersion10(robot);
  addWhatUrdfdomDemands(robot);
  tinyxml2::XMLPrinter printer(nullptr, true);
  copy.Accept(&printer);
  return printer.CStr();
}

/// Links of urdfdom own those below them, and would be freed by as many nested calls as a chain is
/// long.
struct Unchained {
  urdf::ModelInterface& model;
  ~Unchained() {
    for (auto& [name, link] : model.links_) {
      link->child_links.clear();
      link->child_joints.clear();
    }
  }
};

/// Compares one element with urdfdom's; throws at its place in the file.
class Comparison {
 public:
  Comparison(const SourceLocation& where, std::string element)
      : where_(where), element_(std::move(element)) {}

  void expect(bool equal, const char* what) const {
    if (!equal)
      throw ModelError(where_, element_,
                       fmt::format("urdfdom reads another {} than the file says", what));
  }
  void number(double ours, double theirs, const char* what) const {
    // Decimal texts are read to the last bit by both; scaled sizes and angles are not.
    const double scale = std::max(std::abs(ours), std::abs(theirs));
    expect(std::abs(ours - theirs) <= 1e-12 * scale, what);
  }
  void vector(const Vector3& ours, const urdf::Vector3& theirs, const char* what) const {
    number(ours.x(), theirs.x, what);
    number(ours.y(), theirs.y, what);
    number(ours.z(), theirs.z, what);
  }
  void pose(const Transform& ours, const urdf::Pose& theirs, const char* what) const {
    vector(ours.p, theirs.position, what);
    expect((ours.R - rotation(theirs)).cwiseAbs().maxCoeff() <= 1e-9, what);
  }
  static Matrix3 rotation(const urdf::Pose& pose) {
    const urdf::Rotation& r = pose.rotation;
    return Quaternion(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  }

 private:
  SourceLocation where_;
  std::string element_;
};

void compare(const UrdfShape& ours, const urdf::Collision* theirs) {
  const Comparison is(ours.element.where(), ours.element.label());
  is.expect(theirs && theirs->geometry, "geometry");
  is.pose(ours.X_LG, theirs->origin, "origin");
  if (const auto* box = dynamic_cast<const urdf::Box*>(theirs->geometry.get())) {
    is.expect(ours.shape.kind == ShapeKind::box, "geometry");
    is.vector(2.0 * ours.shape.halfExtents, box->dim, "size");
  } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(theirs->geometry.get())) {
    is.expect(ours.shape.kind == ShapeKind::sphere, "geometry");
    is.number(ours.shape.radius, sphere->radius, "radius");
  } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(theirs->geometry.get())) {
    const bool isRound =
        ours.shape.kind == ShapeKind::cylinder || ours.shape.kind == ShapeKind::capsule;
    is.expect(isRound, "geometry");
    is.number(ours.shape.radius, cylinder->radius, "radius");
    is.number(2.0 * ours.shape.halfLength, cylinder->length, "length");
  } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(theirs->geometry.get())) {
    is.expect(ours.shape.kind == ShapeKind::mesh, "geometry");
    is.expect(ours.meshUri == mesh->filename, "mesh file");
    is.vector(ours.scale, mesh->scale, "scale");
  }
}

void compare(const UrdfLink& ours, const urdf::Link* theirs) {
  const Comparison is(ours.spec.where, fmt::format("link '{}'", ours.spec.name));
  is.expect(theirs != nullptr, "set of links");
  is.expect(ours.hasInertial == (theirs->inertial != nullptr), "inertial");
  if (const urdf::Inertial* inertial = theirs->inertial.get()) {
    is.number(ours.spec.mass, inertial->mass, "mass");
    is.vector(ours.spec.com, inertial->origin.position, "inertial origin");
    Matrix3 I;
    I << inertial->ixx, inertial->ixy, inertial->ixz, inertial->ixy, inertial->iyy, inertial->iyz,
        inertial->ixz, inertial->iyz, inertial->izz;
    const Matrix3 R = Comparison::rotation(inertial->origin);
    const double error = (ours.spec.I_Lcm - R * I * R.transpose()).cwiseAbs().maxCoeff();
    is.expect(error <= 1e-9 * I.cwiseAbs().maxCoeff(), "inertia");
  }
  is.expect(ours.collisions.size() == theirs->collision_array.size(), "number of collisions");
  for (std::size_t i = 0; i < ours.collisions.size(); ++i)
    compare(ours.collisions[i], theirs->collision_array[i].get());
}

int typeOf(JointType type) {
  switch (type) {
    case JointType::fixed:
      return urdf::Joint::FIXED;
    case JointType::revolute:
      return urdf::Joint::REVOLUTE;
    case JointType::continuous:
      return urdf::Joint::CONTINUOUS;
    case JointType::prismatic:
      return urdf::Joint::PRISMATIC;
    case JointType::floating:
      return urdf::Joint::FLOATING;
    case JointType::planar:
      return urdf::Joint::PLANAR;
  }
  return urdf::Joint::UNKNOWN;
}

void compare(const JointSpec& ours, const urdf::Joint* theirs) {
  const Comparison is(ours.where, fmt::format("joint '{}'", ours.name));
  is.expect(theirs != nullptr, "set of joints");
  is.expect(typeOf(ours.type) == theirs->type, "type");
  is.expect(ours.parent == theirs->parent_link_name, "parent");
  is.expect(ours.child == theirs->child_link_name, "child");
  is.pose(ours.X_PC, theirs->parent_to_joint_origin_transform, "origin");
  if (ours.type != JointType::fixed && ours.type != JointType::floating)
    is.vector(ours.axis, theirs->axis, "axis");
  if (const urdf::JointLimits* limits = theirs->limits.get()) {
    is.number(ours.effort.value_or(0.0), limits->effort, "effort");
    is.number(ours.velocity.value_or(0.0), limits->velocity, "velocity");
    if (ours.lower) is.number(*ours.lower, limits->lower, "lower limit");
    if (ours.upper) is.number(*ours.upper, limits->upper, "upper limit");
  } else {
    is.expect(!ours.effort && !ours.velocity && !ours.lower && !ours.upper, "limit");
  }
  const urdf::JointDynamics* dynamics = theirs->dynamics.get();
  is.number(ours.damping, dynamics ? dynamics->damping : 0.0, "damping");
  is.number(ours.dryFriction, dynamics ? dynamics->friction : 0.0, "friction");
  if (ours.mimic) {
    is.expect(theirs->mimic && theirs->mimic->joint_name == ours.mimic->leader, "mimic");
    is.number(ours.mimic->multiplier, theirs->mimic->multiplier, "mimic multiplier");
    is.number(ours.mimic->offset, theirs->mimic->offset, "mimic offset");
  }
}

/// All links hang from one root, by one joint each.
bool isTree(const UrdfDescription& urdf) {
  std::unordered_multimap<std::string_view, std::string_view> children;
  std::set<std::string_view> roots;
  for (const UrdfLink& link : urdf.links) roots.insert(link.spec.name);
  for (const JointSpec& joint : urdf.joints) {
    children.emplace(joint.parent, joint.child);
    roots.erase(joint.child);
  }
  std::set<std::string_view> reached = roots;
  std::vector<std::string_view> stack(roots.begin(), roots.end());
  while (!stack.empty()) {
    const auto [begin, end] = children.equal_range(stack.back());
    stack.pop_back();
    for (auto it = begin; it != end; ++it)
      if (reached.insert(it->second).second) stack.push_back(it->second);
  }
  return reached.size() == urdf.links.size() && urdf.joints.size() + 1 == urdf.links.size();
}

/// Of larger files urdfdom would need as much memory again, and no robot has as many.
constexpr std::size_t kMostLinks = 20000;

}  // namespace

std::string compareWithUrdfdom(const XmlFile& file, const UrdfDescription& urdf) {
  // urdfdom never frees links that are their own ancestors, so it is shown trees only.
  if (!isTree(urdf)) return "its links form no tree";
  if (urdf.links.size() > kMostLinks) return {};
  const std::string text = copyFor10(file);
  Listener listener;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    return error.what();
  }
  if (!model) return listener.errors.empty() ? "no reason given" : listener.errors;
  const Unchained unchained{*model};

  const Comparison is(file.robot().where(), "robot");
  is.expect(model->name_ == urdf.name, "name");
  is.expect(model->links_.size() == urdf.links.size(), "number of links");
  is.expect(model->joints_.size() == urdf.joints.size(), "number of joints");
  for (const UrdfLink& link : urdf.links) compare(link, model->getLink(link.spec.name).get());
  for (const JointSpec& joint : urdf.joints) compare(joint, model->getJoint(joint.name).get());
  return {};
}

}  // namespace softgauss::io::detail

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/urdf_description.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>

#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/urdf_joints.hpp"
#include "softgauss/io/detail/urdf_schema.hpp"
#include "softgauss/io/detail/yaml.hpp"

namespace softgauss::io::detail {
namespace {

/// Mass, centre of mass and the inertia turned from the axes of <origin> into those of the link.
void readInertial(const XmlElement& inertial, LinkSpec& link) {
  const Transform X_LI = inertial.origin();
  link.mass = inertial.requiredChild("mass").requiredNumber("value");
  link.com = X_LI.p;
  const XmlElement inertia = inertial.requiredChild("inertia");
  Symmetric3 I;
  I.xx = inertia.requiredNumber("ixx");
  I.yy = inertia.requiredNumber("iyy");
  I.zz = inertia.requiredNumber("izz");
  I.xy = inertia.requiredNumber("ixy");
  I.xz = inertia.requiredNumber("ixz");
  I.yz = inertia.requiredNumber("iyz");
  link.I_Lcm = rotated(X_LI.R, I).matrix();
}

/// The size, or a defect of the shape when it is not positive.
double positive(double size, const char* what, const XmlElement& element, UrdfShape& shape) {
  if (size <= 0.0 && !shape.defect)
    shape.defect =
        ModelError(element.where(), element.label(),
                   fmt::format("{} is {} m, expected more than 0", what, shortNumber(size)));
  return size;
}

void readSolid(const XmlElement& solid, UrdfShape& shape) {
  const std::string tag = solid.tag();
  if (tag == "box") {
    const Vector3 size = solid.requiredVector3("size");
    positive(size.minCoeff(), "the smallest size", solid, shape);
    shape.isPoint = size.isZero(0.0);
    shape.shape = Shape::box(0.5 * size);
  } else if (tag == "sphere") {
    shape.shape = Shape::sphere(positive(solid.requiredNumber("radius"), "radius", solid, shape));
    shape.isPoint = shape.shape.radius == 0.0;
  } else if (tag == "cylinder" || tag == "capsule") {
    const double radius = positive(solid.requiredNumber("radius"), "radius", solid, shape);
    const double length = positive(solid.requiredNumber("length"), "length", solid, shape);
    shape.isPoint = radius == 0.0 && length == 0.0;
    shape.shape = tag == "cylinder" ? Shape::cylinder(radius, 0.5 * length)
                                    : Shape::capsule(radius, 0.5 * length);
  } else if (tag == "mesh") {
    shape.shape = Shape::hull(nullptr);
    shape.meshUri = solid.requiredText("filename");
    shape.scale = solid.vector3("scale").value_or(Vector3::Ones());
    if ((shape.scale.array() == 0.0).any())
      shape.defect = ModelError(solid.where(), solid.label(), "scale holds a zero, expected none");
  } else {
    shape.defect = ModelError(solid.where(), solid.label(),
                              "unknown geometry, expected box, sphere, cylinder, capsule or mesh");
  }
}

UrdfShape readShape(const XmlElement& element) {
  UrdfShape shape;
  shape.element = element;
  shape.X_LG = element.origin();
  const XmlElement geometry = element.requiredChild("geometry");
  std::vector<XmlElement> solids = geometry.children();
  // What has a prefix is another tool's.
  std::erase_if(solids, [](const XmlElement& e) { return e.tag().find(':') != std::string::npos; });
  if (solids.size() != 1)
    geometry.fail(fmt::format("holds {}, expected one box, sphere, cylinder, capsule or mesh",
                              counted(solids.size(), "shape")));
  readSolid(solids.front(), shape);
  return shape;
}

/// The colour of a material, if it has one that can be read. Colours never stop a simulation.
std::optional<Eigen::Vector4d> readColour(const XmlElement& material,
                                          std::vector<std::string>& warnings) {
  const std::vector<XmlElement> colours = material.children("color");
  if (colours.empty()) return std::nullopt;
  const std::string text = colours.front().firstText("rgba");
  const std::optional<std::vector<double>> rgba = parseNumbers(text);
  if (rgba && rgba->size() == 4)
    return Eigen::Vector4d((*rgba)[0], (*rgba)[1], (*rgba)[2], (*rgba)[3]);
  warnings.push_back(fmt::format("line {}: {}: rgba is {}, expected four numbers; not used",
                                 material.where().line, material.label(), quotedText(text)));
  return std::nullopt;
}

void readMaterial(const XmlElement& visual, UrdfShape& shape, UrdfDescription& urdf) {
  const std::vector<XmlElement> materials = visual.children("material");
  if (materials.empty()) return;
  const XmlElement& material = materials.front();
  shape.material = material.firstText("name");
  shape.rgba = readColour(material, urdf.warnings);
  // A material defined inside a visual may be used by name elsewhere.
  if (shape.rgba && !shape.material.empty()) urdf.colours.emplace(shape.material, *shape.rgba);
}

/// What is wrong with it stops no simulation: it becomes the shape's defect.
UrdfShape readVisual(const XmlElement& element, UrdfDescription& urdf) {
  UrdfShape shape;
  try {
    shape = readShape(element);
    readMaterial(element, shape, urdf);
  } catch (const ModelError& error) {
    shape.defect = error;
  }
  return shape;
}

UrdfLink readLink(const XmlElement& unnamed, UrdfDescription& urdf) {
  UrdfLink link;
  link.spec.name = unnamed.named("link").requiredText("name");
  const XmlElement element = unnamed.named("link " + quotedText(link.spec.name));
  link.spec.where = element.where();
  if (const XmlElement inertial = element.child("inertial")) {
    link.hasInertial = true;
    readInertial(inertial, link.spec);
  }
  for (const XmlElement& collision : element.children("collision")) {
    UrdfShape shape = readShape(collision);
    if (shape.defect && !shape.isPoint) throw *shape.defect;
    link.collisions.push_back(std::move(shape));
  }
  for (const XmlElement& visual : element.children("visual"))
    link.visuals.push_back(readVisual(visual, urdf));
  return link;
}

/// A number in an element of Gazebo's, which has it as text or as an attribute `value`.
std::optional<double> gazeboNumber(const XmlElement& extension, const char* tag) {
  const std::vector<XmlElement> found = extension.children(tag);
  if (found.empty()) return std::nullopt;
  const std::string text = found.front().text("value").value_or(found.front().content());
  const std::optional<std::vector<double>> numbers = parseNumbers(text);
  if (!numbers || numbers->size() != 1 || !((*numbers)[0] >= 0.0) || !std::isfinite((*numbers)[0]))
    extension.fail(fmt::format("{} is {}, expected one number, 0 or more", tag, quotedText(text)));
  return (*numbers)[0];
}

/// The friction of links, of `<gazebo reference=…>` with mu1 and mu2; the smaller of the two.
void readGazebo(const XmlElement& robot, UrdfDescription& urdf) {
  std::vector<std::string> unequal;
  for (const XmlElement& unnamed : robot.children("gazebo")) {
    const std::string name = unnamed.firstText("reference");
    const XmlElement extension = unnamed.named("gazebo of " + quotedText(name));
    const auto link = std::find_if(urdf.links.begin(), urdf.links.end(),
                                   [&](const UrdfLink& l) { return l.spec.name == name; });
    if (link == urdf.links.end()) continue;
    const std::optional<double> mu1 = gazeboNumber(extension, "mu1"),
                                mu2 = gazeboNumber(extension, "mu2");
    if (!mu1 && !mu2) continue;
    link->friction = std::min(mu1.value_or(kInfinity), mu2.value_or(kInfinity));
    if (mu1 && mu2 && *mu1 != *mu2) unequal.push_back(name);
  }
  if (!unequal.empty())
    urdf.warnings.push_back("mu1 and mu2 differ, the smaller is taken: " + listed(unequal));
}

/// Moments of inertia that no distribution of mass has: the largest exceeds the sum of the others.
bool breaksTriangleInequality(const LinkSpec& link) {
  if (link.mass <= 0.0) return false;
  // Second moments of mass, ∫ r rᵀ dm: positive semidefinite exactly if the inequality holds.
  const Matrix3 second = 0.5 * link.I_Lcm.trace() * Matrix3::Identity() - link.I_Lcm;
  const Vector3 moments =
      Eigen::SelfAdjointEigenSolver<Matrix3>(second, Eigen::EigenvaluesOnly).eigenvalues();
  return moments.minCoeff() < -1e-6 * link.I_Lcm.trace();
}

/// Every link but one hangs from a joint.
void checkRoots(const XmlElement& robot, const UrdfDescription& urdf) {
  if (urdf.links.empty()) robot.fail("has no <link>, expected at least one");
  std::set<std::string> children;
  for (const JointSpec& joint : urdf.joints) children.insert(joint.child);
  const LinkSpec* root = nullptr;
  for (const UrdfLink& link : urdf.links) {
    if (children.count(link.spec.name)) continue;
    if (root && root->name != link.spec.name)
      throw ModelError(link.spec.where, "link " + quotedText(link.spec.name),
                       fmt::format("is a second root beside {} (line {}), expected it to be the "
                                   "child of a joint",
                                   quotedText(root->name), root->where.line));
    if (!root) root = &link.spec;
  }
}

}  // namespace

UrdfDescription describeUrdf(const XmlElement& robot) {
  UrdfDescription urdf;
  urdf.name = robot.requiredText("name");
  robot.urdfMinorVersion();  // refuses one that is not known
  for (const XmlElement& material : robot.children("material"))
    if (const auto rgba = readColour(material, urdf.warnings))
      urdf.colours[material.firstText("name")] = *rgba;
  for (const XmlElement& link : robot.children("link")) urdf.links.push_back(readLink(link, urdf));

  std::vector<std::string> linkNames;
  for (const UrdfLink& link : urdf.links) linkNames.push_back(link.spec.name);
  urdf.joints = readJoints(robot, linkNames, urdf.warnings);
  checkRoots(robot, urdf);

  std::vector<std::string> odd, points;
  for (const UrdfLink& link : urdf.links) {
    if (breaksTriangleInequality(link.spec)) odd.push_back(link.spec.name);
    for (const UrdfShape& shape : link.collisions)
      if (shape.isPoint)
        points.push_back(fmt::format("line {}: {}", shape.element.where().line, link.spec.name));
  }
  if (!points.empty())
    urdf.warnings.push_back("shapes of no size, which touch nothing and are left out: " +
                            listed(points));
  if (!odd.empty())
    urdf.warnings.push_back(
        "inertia that no body can have (one principal moment exceeds the sum of the other two), "
        "used as written: " +
        listed(odd));
  readGazebo(robot, urdf);
  const std::vector<std::string> ignored = ignoredParts(robot);
  if (!ignored.empty()) urdf.warnings.push_back("ignored: " + listed(ignored, 40));
  for (std::string& warning : urdf.warnings) warning = validUtf8(warning);
  return urdf;
}

}  // namespace softgauss::io::detail

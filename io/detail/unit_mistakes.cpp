// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/unit_mistakes.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kTurn = 2.0 * M_PI * 1.01;  ///< of a pose; 6.2832 is a turn that was rounded
constexpr double kLeastRange = 10.0;         ///< [rad] that may be degrees
constexpr double kMostRange = 720.0;         ///< [rad] above which a range means none
constexpr double kFarLarger = 20.0;          ///< times the robot
constexpr double kMillimetre = 1e-3;
constexpr double kImpossible = 20.0;    ///< of m R²
constexpr double kUsualInertia = 0.2;   ///< of m R²: a box has 0.22, a ball 0.4, a rod 0.33
constexpr double kLeastInertia = 0.01;  ///< of m R², of what was probably meant

struct InertiaUnit {
  const char* name;
  double factor;  ///< to kg m²
};
constexpr InertiaUnit kInertiaUnits[] = {
    {"kg cm²", 1e-4}, {"kg mm²", 1e-6}, {"g cm²", 1e-7}, {"g mm²", 1e-9}};

using Box = Eigen::AlignedBox3d;

/// The boxes about meshes, each worked out once however many shapes have it.
class MeshBoxes {
 public:
  const Box& of(const Mesh& mesh) {
    const auto [at, isNew] = boxes_.try_emplace(&mesh);
    if (isNew)
      for (const Vector3& vertex : mesh.vertices) at->second.extend(vertex);
    return at->second;
  }

 private:
  std::unordered_map<const Mesh*, Box> boxes_;
};

/// The farthest that a shape is from a point of its link [m], a mesh as the box about it; 0 for a
/// mesh that was not read.
double farthest(const UrdfShape& shape, const Vector3& p_LP, MeshBoxes& boxes) {
  const Shape& s = shape.shape;
  const double centre = (shape.X_LG.p - p_LP).norm();
  switch (s.kind) {
    case ShapeKind::plane:
      return 0.0;
    case ShapeKind::sphere:
      return centre + s.radius;
    case ShapeKind::capsule:
      return centre + s.halfLength + s.radius;
    case ShapeKind::cylinder:
      return centre + std::hypot(s.halfLength, s.radius);
    case ShapeKind::box:
      return centre + s.halfExtents.norm();
    case ShapeKind::ellipsoid:
      return centre + s.halfExtents.maxCoeff();
    case ShapeKind::mesh:
    case ShapeKind::triangles:
      break;
  }
  double most = 0.0;
  if (s.mesh && !s.mesh->vertices.empty())
    for (int corner = 0; corner < 8; ++corner)
      most = std::max(
          most, (shape.X_LG * boxes.of(*s.mesh).corner(static_cast<Box::CornerType>(corner)) - p_LP)
                    .norm());
  return most;
}

double radiusAbout(const UrdfLink& link, const Vector3& p_LP, MeshBoxes& boxes) {
  double most = 0.0;
  for (const std::vector<UrdfShape>* shapes : {&link.collisions, &link.visuals})
    for (const UrdfShape& shape : *shapes)
      if (!shape.defect) most = std::max(most, farthest(shape, p_LP, boxes));
  return most;
}

double largestMoment(const LinkSpec& link) {
  return Eigen::SelfAdjointEigenSolver<Matrix3>(link.I_Lcm, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// " (… kg m² if it is in …)" of the unit that gives a usual body, if one does.
std::string inertiaMeant(double moment, double most) {
  const auto unlikely = [&](const InertiaUnit& unit) {
    return std::abs(std::log(moment * unit.factor / (kUsualInertia * most)));
  };
  const InertiaUnit& unit = *std::min_element(
      std::begin(kInertiaUnits), std::end(kInertiaUnits),
      [&](const InertiaUnit& a, const InertiaUnit& b) { return unlikely(a) < unlikely(b); });
  const double share = moment * unit.factor / most;
  if (share > 1.0 || share < kLeastInertia) return {};
  return fmt::format(" ({} kg m² if it is in {})", shortNumber(moment * unit.factor), unit.name);
}

std::vector<std::string> ranges(const UrdfDescription& urdf) {
  std::vector<std::string> found;
  for (const JointSpec& joint : urdf.joints) {
    if (joint.type != JointType::revolute || !joint.lower || !joint.upper) continue;
    const double most = std::max(std::abs(*joint.lower), std::abs(*joint.upper));
    if (most > kLeastRange && most <= kMostRange)
      found.push_back(fmt::format("joint '{}' {} .. {} rad ({} .. {} rad if it is in degrees)",
                                  joint.name, shortNumber(*joint.lower), shortNumber(*joint.upper),
                                  shortNumber(*joint.lower * kDegree),
                                  shortNumber(*joint.upper * kDegree)));
  }
  return found;
}

void addPoses(const XmlElement& element, std::vector<std::string>& found) {
  for (const XmlElement& child : element.children()) {
    if (child.tag() == "origin") {
      const std::string rpy = child.firstText("rpy");
      const std::string meant = radiansMeant(parseNumbers(rpy).value_or(std::vector<double>{}));
      if (!meant.empty())
        found.push_back(
            fmt::format("line {} '{}' ({} if it is in degrees)", child.where().line, rpy, meant));
    } else {
      addPoses(child, found);
    }
  }
}

/// Where the links are at q = 0, in their root.
std::unordered_map<std::string, Transform> linkPoses(const UrdfDescription& urdf) {
  std::unordered_map<std::string, const JointSpec*> jointAbove;
  for (const JointSpec& joint : urdf.joints) jointAbove[joint.child] = &joint;
  std::unordered_map<std::string, Transform> poses;
  for (const UrdfLink& link : urdf.links) {
    // Up to what is known, and down again. A cycle, which is refused later, ends after all joints.
    std::vector<const JointSpec*> path;
    std::string at = link.spec.name;
    for (auto joint = jointAbove.find(at);
         !poses.count(at) && joint != jointAbove.end() && path.size() < urdf.joints.size();
         joint = jointAbove.find(at)) {
      path.push_back(joint->second);
      at = joint->second->parent;
    }
    Transform X = poses[at];
    for (auto joint = path.rbegin(); joint != path.rend(); ++joint)
      X = poses[(*joint)->child] = X * (*joint)->X_PC;
  }
  return poses;
}

/// How far the links' origins, centres of mass and shapes but for meshes spread [m].
double extentOf(const UrdfDescription& urdf, MeshBoxes& boxes) {
  const std::unordered_map<std::string, Transform> poses = linkPoses(urdf);
  Box origins;
  double size = 0.0;
  for (const UrdfLink& link : urdf.links) {
    origins.extend(poses.at(link.spec.name).p);
    size = std::max(size, 2.0 * link.spec.com.norm());
    for (const UrdfShape& shape : link.collisions)
      if (!shape.shape.isMesh()) size = std::max(size, 2.0 * farthest(shape, shape.X_LG.p, boxes));
  }
  return std::max(size, origins.diagonal().norm());
}

/// That, or how far its masses are spread [m].
double robotSize(const UrdfDescription& urdf, double extent) {
  double size = extent;
  for (const UrdfLink& link : urdf.links)
    if (link.spec.mass > 0.0)
      size = std::max(size, 2.0 * std::sqrt(largestMoment(link.spec) / link.spec.mass));
  return size;
}

/// Of a link without shapes that have been read, the robot's extent bounds the size.
std::vector<std::string> inertias(const UrdfDescription& urdf, double extent, MeshBoxes& boxes) {
  std::vector<std::string> found;
  for (const UrdfLink& link : urdf.links) {
    double radius = radiusAbout(link, link.spec.com, boxes);
    if (radius == 0.0) radius = extent;
    if (radius == 0.0 || link.spec.mass <= 0.0) continue;
    const double moment = largestMoment(link.spec), most = link.spec.mass * radius * radius;
    if (moment > kImpossible * most)
      found.push_back(fmt::format("link '{}' has {} kg m², {} kg within {} m have at most {}{}",
                                  link.spec.name, shortNumber(moment), shortNumber(link.spec.mass),
                                  shortNumber(radius), shortNumber(most),
                                  inertiaMeant(moment, most)));
  }
  return found;
}

std::vector<std::string> meshes(const UrdfDescription& urdf, double robot, MeshBoxes& boxes) {
  std::vector<std::string> found;
  for (const UrdfLink& link : urdf.links)
    for (const std::vector<UrdfShape>* shapes : {&link.collisions, &link.visuals})
      for (const UrdfShape& shape : *shapes) {
        if (!shape.shape.mesh || shape.shape.mesh->vertices.empty()) continue;
        const double size = boxes.of(*shape.shape.mesh).diagonal().norm();
        const Vector3 scale = kMillimetre * shape.scale;
        if (robot > 0.0 && size > kFarLarger * robot)
          found.push_back(
              fmt::format("'{}' of link '{}', {} m ({} m with scale=\"{:g} {:g} {:g}\")",
                          shape.meshUri, link.spec.name, shortNumber(size),
                          shortNumber(kMillimetre * size), scale.x(), scale.y(), scale.z()));
      }
  return found;
}

}  // namespace

std::string radiansMeant(const Model& model, const JointRange& range, double position) {
  constexpr double kLeastDegrees = 5.0;  // less is no angle that people give in degrees
  const double radians = position * kDegree;
  const auto isBeyond = [&](double q) { return q < range.lower || q > range.upper; };
  if (model.bodies[idx(range.body)].joint != JointKind::revolute || !isBeyond(position) ||
      isBeyond(radians) || std::abs(position) < kLeastDegrees)
    return {};
  return fmt::format(" ({} rad if it is in degrees)", shortNumber(radians));
}

std::string radiansMeant(const std::vector<double>& angles) {
  std::string meant;
  for (const double angle : angles) meant += shortNumber(angle * kDegree) + " ";
  const bool turns = std::any_of(angles.begin(), angles.end(),
                                 [](double angle) { return std::abs(angle) > kTurn; });
  return turns ? meant + "rad" : std::string();
}

std::vector<std::string> unitMistakes(const XmlElement& robot, const UrdfDescription& urdf) {
  std::vector<std::string> warnings, poses;
  const auto add = [&](const std::vector<std::string>& found, const char* text) {
    if (!found.empty()) warnings.push_back(text + listed(found, 6));
  };
  addPoses(robot, poses);
  add(poses, "rpy of more than a turn, used as written: ");
  add(ranges(urdf), "ranges of several turns, used as written: ");
  MeshBoxes boxes;
  const double extent = extentOf(urdf, boxes);
  add(inertias(urdf, extent, boxes),
      "inertia that no body of that mass and size can have, used as written: ");
  const double robotIs = robotSize(urdf, extent);
  add(meshes(urdf, robotIs, boxes),
      fmt::format("meshes far larger than the robot, which is some {} m large, used as written: ",
                  shortNumber(robotIs))
          .c_str());
  return warnings;
}

}  // namespace softgauss::io::detail

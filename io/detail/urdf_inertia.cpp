// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/urdf_inertia.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>

#include "softgauss/engine/model/closed_surface.hpp"
#include "softgauss/engine/model/mass_properties.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

constexpr double kDensity = 1000.0;    // [kg/m³]
constexpr double kZeroMoment = 1e-12;  // of the largest: none
constexpr std::size_t kMostTold = 8;

MassProperties boxAround(const Mesh& mesh) {
  Vector3 least = Vector3::Constant(kInfinity), most = -least;
  for (const Vector3& vertex : mesh.vertices) {
    least = least.cwiseMin(vertex);
    most = most.cwiseMax(vertex);
  }
  if (mesh.vertices.empty()) return {};
  MassProperties box = solidOf(Shape::box(0.5 * (most - least)), kDensity);
  box.com = 0.5 * (least + most);
  return box;
}

/// In the axes of the link.
MassProperties propertiesOf(const UrdfShape& written, const Shape& shape) {
  MassProperties p = shape.isMesh() && surfaceDefects(*shape.mesh).any() ? boxAround(*shape.mesh)
                                                                         : solidOf(shape, kDensity);
  const Matrix3& R = written.X_LG.R;
  p.com = written.X_LG * p.com;
  p.I_Gcm = R * p.I_Gcm * R.transpose();
  return p;
}

Matrix3 aboutPoint(const MassProperties& p, const Vector3& point) {
  const Vector3 r = p.com - point;
  return p.I_Gcm + p.mass * (r.squaredNorm() * Matrix3::Identity() - r * r.transpose());
}

MassProperties sumOf(const std::vector<MassProperties>& parts) {
  MassProperties sum;
  Vector3 moment = Vector3::Zero();
  for (const MassProperties& part : parts) sum.mass += part.mass, moment += part.mass * part.com;
  if (!(sum.mass > 0.0)) return sum;
  sum.com = moment / sum.mass;
  for (const MassProperties& part : parts) sum.I_Gcm += aboutPoint(part, sum.com);
  return sum;
}

bool lacksInertia(const LinkSpec& link) {
  const Vector3 moments = Eigen::SelfAdjointEigenSolver<Matrix3>(link.I_Lcm).eigenvalues();
  return !(moments.minCoeff() > kZeroMoment * moments.cwiseAbs().maxCoeff());
}

/// The links of each body that moves, as indices.
std::vector<std::vector<std::size_t>> movingBodies(const UrdfDescription& urdf, bool baseIsFixed) {
  std::map<std::string, std::size_t> indices;
  for (std::size_t i = 0; i < urdf.links.size(); ++i) indices.emplace(urdf.links[i].spec.name, i);
  std::vector<std::size_t> joinedTo(urdf.links.size());  // by a fixed joint, or itself
  std::vector<char> isRoot(urdf.links.size(), 1);
  for (std::size_t i = 0; i < joinedTo.size(); ++i) joinedTo[i] = i;
  for (const JointSpec& joint : urdf.joints) {
    const auto parent = indices.find(joint.parent), child = indices.find(joint.child);
    if (parent == indices.end() || child == indices.end()) continue;  // the builder refuses it
    isRoot[child->second] = 0;
    if (joint.type == JointType::fixed) joinedTo[child->second] = parent->second;
  }
  std::map<std::size_t, std::vector<std::size_t>> bodies;
  for (std::size_t i = 0; i < joinedTo.size(); ++i) {
    std::size_t first = i;
    for (std::size_t n = 0; n < joinedTo.size() && joinedTo[first] != first; ++n)
      first = joinedTo[first];
    bodies[first].push_back(i);
  }
  std::vector<std::vector<std::size_t>> moving;
  for (auto& [first, links] : bodies)
    if (!(isRoot[first] && (baseIsFixed || urdf.links[first].spec.name == "world")))
      moving.push_back(std::move(links));
  return moving;
}

class Inference {
 public:
  explicit Inference(const std::function<Shape(const UrdfShape&)>& solid) : solid_(solid) {}

  void complete(UrdfDescription& urdf, const std::vector<std::size_t>& body) {
    std::vector<std::size_t> massive;
    for (const std::size_t i : body)
      if (urdf.links[i].spec.mass > 0.0) massive.push_back(i);
    if (massive.empty())
      for (const std::size_t i : body) giveMass(urdf.links[i]);
    else if (massive.size() == 1 && lacksInertia(urdf.links[massive[0]].spec))
      giveInertia(urdf.links[massive[0]]);
  }
  std::vector<std::string> told() const {
    std::vector<std::string> lines;
    if (!masses_.empty())
      lines.push_back("mass and inertia are those of the shapes, at 1000 kg/m³: " +
                      listed(masses_, kMostTold));
    if (!inertias_.empty())
      lines.push_back("inertia is that of the shapes, at the mass that is written: " +
                      listed(inertias_, kMostTold));
    return lines;
  }

 private:
  MassProperties solidOfLink(const UrdfLink& link) const {
    std::vector<MassProperties> parts;
    for (const UrdfShape& shape : link.collisions)
      if (!shape.isPoint && !shape.defect) parts.push_back(propertiesOf(shape, solid_(shape)));
    for (const UrdfShape& shape : link.visuals) try {
        if (link.collisions.empty() && !shape.defect)
          parts.push_back(propertiesOf(shape, solid_(shape)));
      } catch (const ModelError&) {
        // A visual that cannot be read stops no simulation; it is told elsewhere.
      }
    return sumOf(parts);
  }
  void giveMass(UrdfLink& link) {
    const MassProperties p = solidOfLink(link);
    if (!(p.mass > 0.0)) return;
    link.spec.mass = p.mass;
    link.spec.com = p.com;
    link.spec.I_Lcm = p.I_Gcm;
    masses_.push_back(fmt::format("'{}' {:.3g} kg", link.spec.name, p.mass));
  }
  void giveInertia(UrdfLink& link) {
    const MassProperties p = solidOfLink(link);
    if (!(p.mass > 0.0)) return;
    link.spec.I_Lcm = link.spec.mass / p.mass * p.I_Gcm;
    inertias_.push_back("'" + link.spec.name + "'");
  }

  const std::function<Shape(const UrdfShape&)>& solid_;
  std::vector<std::string> masses_, inertias_;
};

}  // namespace

std::vector<std::string> inferInertia(UrdfDescription& urdf, bool baseIsFixed,
                                      const std::function<Shape(const UrdfShape&)>& solid) {
  Inference inference(solid);
  for (const std::vector<std::size_t>& body : movingBodies(urdf, baseIsFixed))
    inference.complete(urdf, body);
  return inference.told();
}

}  // namespace softgauss::io::detail

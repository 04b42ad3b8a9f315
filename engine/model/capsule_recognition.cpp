// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/capsule_recognition.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace softgauss {
namespace {

/// Where the end of a cylinder towards +z (side = 1) or −z (side = −1) is, in the link.
Vector3 endOf(const GeometrySpec& cylinder, double side) {
  return cylinder.X_LG * Vector3(0.0, 0.0, side * cylinder.shape.halfLength);
}

double toleranceOf(const Shape& rod) { return kCapsuleTolerance * (rod.radius + rod.halfLength); }

/// Whether a sphere of the cylinder's link caps its end there. Numbers of one material come from
/// one text, so they are equal.
bool caps(const GeometrySpec& sphere, const GeometrySpec& cylinder, const Vector3& end) {
  const double tolerance = toleranceOf(cylinder.shape);
  return std::abs(sphere.shape.radius - cylinder.shape.radius) <= tolerance &&
         (sphere.X_LG.p - end).norm() <= tolerance && sphere.material == cylinder.material;
}

/// The spheres of a link, in order along the axis on which they are spread most: of many, few are
/// near the end of a cylinder.
class Spheres {
 public:
  void add(const std::vector<GeometrySpec>& all, std::size_t index) {
    box_.extend(all[index].X_LG.p);
    spheres_.push_back({0.0, index});
  }

  void sort(const std::vector<GeometrySpec>& all) {
    if (spheres_.empty()) return;
    box_.sizes().maxCoeff(&axis_);
    for (Sphere& sphere : spheres_) sphere.place = all[sphere.index].X_LG.p[axis_];
    std::stable_sort(spheres_.begin(), spheres_.end(),
                     [](const Sphere& a, const Sphere& b) { return a.place < b.place; });
  }

  /// Appends those that cap the end to `found`; true if one does.
  bool find(const std::vector<GeometrySpec>& all, const GeometrySpec& cylinder, const Vector3& end,
            std::vector<std::size_t>& found) const {
    const std::size_t before = found.size();
    const double tolerance = toleranceOf(cylinder.shape);
    for (auto it = std::lower_bound(
             spheres_.begin(), spheres_.end(), end[axis_] - tolerance,
             [](const Sphere&sphere, double place) { return sphere.place < place; });
         it != spheres_.end() && it->place <= end[axis_] + tolerance; ++it)
      if (caps(all[it->index], cylinder, end)) found.push_back(it->index);
    return found.size() > before;
  }

 private:
  struct Sphere {
    double place;  ///< along the axis
    std::size_t index;
  };
  Eigen::AlignedBox3d box_;
  Eigen::Index axis_ = 0;
  std::vector<Sphere> spheres_;
};

}  // namespace

std::vector<GeometrySpec> recogniseCapsules(std::vector<GeometrySpec> geometries) {
  const std::size_t count = geometries.size();
  std::unordered_map<std::string, Spheres> spheres;  // by link
  for (std::size_t i = 0; i < count; ++i)
    if (geometries[i].shape.kind == ShapeKind::sphere)
      spheres[geometries[i].link].add(geometries, i);
  for (auto& [link, ofLink] : spheres) ofLink.sort(geometries);

  std::vector<bool> contained(count, false);  // sphere inside a capsule made here
  std::vector<std::size_t> found;
  for (GeometrySpec& cylinder : geometries) {
    const auto ofLink = spheres.find(cylinder.link);
    if (cylinder.shape.kind != ShapeKind::cylinder || ofLink == spheres.end()) continue;
    found.clear();
    if (!ofLink->second.find(geometries, cylinder, endOf(cylinder, 1.0), found)) continue;
    if (!ofLink->second.find(geometries, cylinder, endOf(cylinder, -1.0), found)) continue;
    cylinder.shape = Shape::capsule(cylinder.shape.radius, cylinder.shape.halfLength);
    for (const std::size_t i : found) contained[i] = true;
  }

  std::vector<GeometrySpec> kept;
  kept.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    if (!contained[i]) kept.push_back(std::move(geometries[i]));
  return kept;
}

}  // namespace softgauss

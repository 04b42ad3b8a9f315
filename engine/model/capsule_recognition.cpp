// SPDX-License-Identifier: Apache-2.0
#include "engine/model/capsule_recognition.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>
#include <utility>

namespace softgauss {
namespace {

/// Spheres of each link in order of x, so that those near a place are found among many.
class Spheres {
 public:
  explicit Spheres(const std::vector<GeometrySpec>& geometries) : geometries_(geometries) {
    for (std::size_t i = 0; i < geometries.size(); ++i)
      if (geometries[i].shape.kind == ShapeKind::sphere)
        ofLink_[geometries[i].link].emplace_back(geometries[i].X_LG.p.x(), i);
    for (auto& [link, spheres] : ofLink_) std::sort(spheres.begin(), spheres.end());
  }

  /// Appends those that cap the end of `cylinder` towards +z (side = 1) or −z (side = −1). False:
  /// none does. Numbers of one material come from one text, so they are equal.
  bool appendCaps(const GeometrySpec& cylinder, double side,
                  std::vector<std::size_t>& found) const {
    const auto spheres = ofLink_.find(cylinder.link);
    if (spheres == ofLink_.end()) return false;
    const Shape& rod = cylinder.shape;
    const Vector3 end = cylinder.X_LG * Vector3(0.0, 0.0, side * rod.halfLength);
    const double tolerance = kCapsuleTolerance * (rod.radius + rod.halfLength);
    const std::size_t before = found.size();
    // A little more than the tolerance, lest rounding leave out one at its edge.
    auto it = std::lower_bound(spheres->second.begin(), spheres->second.end(),
                               std::pair(end.x() - 2.0 * tolerance, std::size_t{0}));
    for (; it != spheres->second.end() && it->first <= end.x() + 2.0 * tolerance; ++it) {
      const GeometrySpec& sphere = geometries_[it->second];
      if (std::abs(sphere.shape.radius - rod.radius) <= tolerance &&
          (sphere.X_LG.p - end).norm() <= tolerance && sphere.material == cylinder.material)
        found.push_back(it->second);
    }
    return found.size() > before;
  }

 private:
  const std::vector<GeometrySpec>& geometries_;
  std::unordered_map<std::string, std::vector<std::pair<double, std::size_t>>> ofLink_;
};

}  // namespace

std::vector<GeometrySpec> recogniseCapsules(std::vector<GeometrySpec> geometries) {
  const std::size_t count = geometries.size();
  std::vector<bool> contained(count, false);  // sphere inside a capsule made here
  const Spheres spheres(geometries);
  for (GeometrySpec& cylinder : geometries) {
    if (cylinder.shape.kind != ShapeKind::cylinder) continue;
    std::vector<std::size_t> found;
    const bool upper = spheres.appendCaps(cylinder, 1.0, found);
    const bool lower = spheres.appendCaps(cylinder, -1.0, found);
    if (!lower || !upper) continue;
    cylinder.shape = Shape::capsule(cylinder.shape.radius, cylinder.shape.halfLength);
    for (std::size_t i : found) contained[i] = true;
  }

  std::vector<GeometrySpec> kept;
  kept.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    if (!contained[i]) kept.push_back(std::move(geometries[i]));
  return kept;
}

}  // namespace softgauss

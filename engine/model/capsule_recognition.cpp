// SPDX-License-Identifier: Apache-2.0
#include "engine/model/capsule_recognition.hpp"

#include <cmath>

namespace softgauss {
namespace {

/// Whether `sphere` caps the end of `cylinder` towards +z (side = 1) or −z (side = −1). Numbers of
/// one material come from one text, so they are equal.
bool caps(const GeometrySpec& sphere, const GeometrySpec& cylinder, double side) {
  const Shape& rod = cylinder.shape;
  if (sphere.shape.kind != ShapeKind::sphere || sphere.link != cylinder.link) return false;
  const Vector3 end = cylinder.X_LG * Vector3(0.0, 0.0, side * rod.halfLength);
  const double tolerance = kCapsuleTolerance * (rod.radius + rod.halfLength);
  return std::abs(sphere.shape.radius - rod.radius) <= tolerance &&
         (sphere.X_LG.p - end).norm() <= tolerance && sphere.material == cylinder.material;
}

}  // namespace

std::vector<GeometrySpec> recogniseCapsules(std::vector<GeometrySpec> geometries) {
  const std::size_t count = geometries.size();
  std::vector<bool> contained(count, false);  // sphere inside a capsule made here
  for (GeometrySpec& cylinder : geometries) {
    if (cylinder.shape.kind != ShapeKind::cylinder) continue;
    std::vector<std::size_t> found;
    bool lower = false, upper = false;
    for (std::size_t i = 0; i < count; ++i) {
      const bool atUpper = caps(geometries[i], cylinder, 1.0);
      const bool atLower = caps(geometries[i], cylinder, -1.0);
      upper = upper || atUpper;
      lower = lower || atLower;
      if (atUpper || atLower) found.push_back(i);
    }
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

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Seeded shapes and poses that overlap or nearly touch.

#include <memory>
#include <random>
#include <vector>

#include "softgauss/collision/primitive_pairs.hpp"
#include "softgauss/engine/core/rotation.hpp"

namespace softgauss::collision {

class RandomPairs {
 public:
  explicit RandomPairs(unsigned seed) : generator_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  Vector3 vector(double size) {
    return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
  }
  Transform pose(double size) {
    const Quaternion q(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    return {q.normalized().toRotationMatrix(), vector(size)};
  }
  Shape shape(ShapeKind kind) {
    switch (kind) {
      case ShapeKind::sphere:
        return Shape::sphere(uniform(0.1, 0.4));
      case ShapeKind::capsule:
        return Shape::capsule(uniform(0.1, 0.3), uniform(0.1, 0.5));
      case ShapeKind::cylinder:
        return Shape::cylinder(uniform(0.1, 0.4), uniform(0.1, 0.5));
      case ShapeKind::box:
        return Shape::box({uniform(0.1, 0.5), uniform(0.1, 0.5), uniform(0.1, 0.5)});
      case ShapeKind::ellipsoid:
        return Shape::ellipsoid({uniform(0.1, 0.5), uniform(0.1, 0.5), uniform(0.1, 0.5)});
      default:
        return Shape::plane();
    }
  }

 private:
  std::mt19937 generator_;
};

/// The mesh of a box, each face split into two triangles.
inline std::shared_ptr<const Mesh> boxMesh(const Vector3& h) {
  auto mesh = std::make_shared<Mesh>();
  for (int i = 0; i < 8; ++i)
    mesh->vertices.push_back(
        Vector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).cwiseProduct(h));
  mesh->file = "box.stl";
  return mesh;
}

/// The deepest distance of a pair, +∞ without contact.
inline double deepest(const PairContacts& contacts) {
  double d = std::numeric_limits<double>::infinity();
  for (int i = 0; i < contacts.count; ++i) d = std::min(d, contacts[i].distance);
  return d;
}

inline PairContacts contactsOf(const Shape& a, const Transform& X_WA, const Shape& b,
                               const Transform& X_WB, double margin = 0.0) {
  PairContacts out;
  collidePrimitives(a, X_WA, b, X_WB, margin, out);
  return out;
}

inline Transform at(double x, double y, double z) {
  return {Matrix3::Identity(), Vector3(x, y, z)};
}

inline Transform turned(const Vector3& axis, double angle, const Vector3& p) {
  return {axisRotation(axis.normalized(), angle), p};
}

}  // namespace softgauss::collision

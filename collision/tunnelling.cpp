// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/tunnelling.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::collision {
namespace {

/// Twice the distance of the box's centre from the nearest face: no width of the hull is less.
double hullThickness(const ConvexHull& hull) {
  double nearest = kInfinity;
  for (const HullFace& face : hull.faces) {
    const Vector3& onFace = hull.vertices[static_cast<std::size_t>(face.vertices.front())];
    nearest = std::min(nearest, face.normal.dot(onFace - hull.centre));
  }
  return 2.0 * std::max(nearest, 0.0);
}

/// How fast the shapes can come near along n, from A to B, within `longest`: what their centres do,
/// what spin adds, and how far velocities turn on average.
double closing(const MovingShape& a, const MovingShape& b, const Vector3& n, double longest) {
  const double spin = a.omega.norm() * a.extent.lever + b.omega.norm() * b.extent.lever;
  const double turning =
      0.5 * longest * (a.omega.norm() * a.v.norm() + b.omega.norm() * b.v.norm());
  return spin + std::min((b.v - a.v).norm(), turning - n.dot(b.v - a.v));
}

/// A time in which the two do not touch, as the shadows on n tell; at most `longest`.
double untouched(const MovingShape& a, const MovingShape& b, Vector3 n, double margin,
                 double longest) {
  double distance = n.dot(b.centre - a.centre);
  if (distance < 0.0) n = -n, distance = -distance;
  const double gap = distance - halfWidth(a, n) - halfWidth(b, n) - margin;
  if (!(gap > 0.0)) return 0.0;
  const double speed = closing(a, b, n, longest);
  return gap >= longest * speed ? longest : gap / speed;
}

}  // namespace

Extent extentOf(const Shape& shape, const ConvexHull* hull, const TriangleMesh* surface) {
  switch (shape.kind) {
    case ShapeKind::plane:
      return {kInfinity, 0.0};
    case ShapeKind::sphere:
      return {2.0 * shape.radius, 0.0};
    case ShapeKind::capsule:
      return {2.0 * shape.radius, shape.halfLength};
    case ShapeKind::cylinder:
      return {2.0 * std::min(shape.radius, shape.halfLength),
              std::hypot(shape.radius, shape.halfLength)};
    case ShapeKind::box:
      return {2.0 * shape.halfExtents.minCoeff(), shape.halfExtents.norm()};
    case ShapeKind::ellipsoid:
      return {2.0 * shape.halfExtents.minCoeff(), shape.halfExtents.maxCoeff()};
    case ShapeKind::mesh:
      return {hullThickness(*hull), hull->boundingRadius};
    case ShapeKind::triangles:
      return {0.0, surface->boundingRadius()};
  }
  return {};
}

double halfWidth(const MovingShape& f, const Vector3& n) {
  const Shape& shape = *f.shape;
  switch (shape.kind) {
    case ShapeKind::plane:
      return kInfinity;
    case ShapeKind::sphere:
      return shape.radius;
    case ShapeKind::capsule:
      return shape.radius + shape.halfLength * std::abs(f.X_WG->R.col(2).dot(n));
    case ShapeKind::cylinder: {
      const double along = f.X_WG->R.col(2).dot(n);
      return shape.halfLength * std::abs(along) +
             shape.radius * std::sqrt(std::max(0.0, 1.0 - along * along));
    }
    case ShapeKind::box:
      return (f.X_WG->R.transpose() * n).cwiseAbs().dot(shape.halfExtents);
    case ShapeKind::ellipsoid:
      return (f.X_WG->R.transpose() * n).cwiseProduct(shape.halfExtents).norm();
    case ShapeKind::mesh:
      return (f.X_WG->R.transpose() * n).cwiseAbs().dot(f.hull->halfExtents);
    case ShapeKind::triangles:
      return (f.X_WG->R.transpose() * n).cwiseAbs().dot(f.surface->halfExtents());
  }
  return 0.0;
}

double tunnellingTimeBound(const MovingShape& a, const MovingShape& b, double margin,
                           double longest) {
  const double u =
      (b.v - a.v).norm() + a.omega.norm() * a.extent.lever + b.omega.norm() * b.extent.lever;
  const double thickness = a.extent.thickness + b.extent.thickness;
  if (!(longest * u > kPassShare * thickness)) return longest;
  double apart = 0.0;
  const Vector3 line = b.centre - a.centre;
  if (line.squaredNorm() > 0.0) apart = untouched(a, b, line.normalized(), margin, longest);
  for (const MovingShape* f : {&a, &b}) {
    const ShapeKind kind = f->shape->kind;
    const bool axis = kind == ShapeKind::capsule || kind == ShapeKind::cylinder;
    const int first = kind == ShapeKind::sphere ? 3 : axis ? 2 : 0;
    for (int i = first; i < 3 && apart < longest; ++i)
      apart = std::max(apart, untouched(a, b, f->X_WG->R.col(i), margin, longest));
  }
  return std::min(longest, std::max(apart, kPassShare * thickness / u));
}

}  // namespace softgauss::collision

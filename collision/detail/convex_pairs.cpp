// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/convex_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "softgauss/collision/box_pairs.hpp"
#include "softgauss/collision/detail/separating_direction.hpp"
#include "softgauss/collision/manifold.hpp"

namespace softgauss::collision::detail {
namespace {

/// A face normal is preferred to the free direction up to this loss of separation, relative to
/// size.
constexpr double kFacePreference = 1e-6;

Vector3 localHalfExtents(const Shape& s, const ConvexHull* hull) {
  switch (s.kind) {
    case ShapeKind::sphere:
      return Vector3::Constant(s.radius);
    case ShapeKind::capsule:
      return {s.radius, s.radius, s.radius + s.halfLength};
    case ShapeKind::cylinder:
      return {s.radius, s.radius, s.halfLength};
    case ShapeKind::box:
    case ShapeKind::ellipsoid:
      return s.halfExtents;
    default:
      return hull->halfExtents;
  }
}

/// Midway between the nearest points of two straight lines of contact.
Vector3 betweenLines(const SupportFace& a, const SupportFace& b) {
  const Vector3 u = a[1] - a[0], w = b[1] - b[0], r = a[0] - b[0];
  const double uu = u.squaredNorm(), ww = w.squaredNorm(), uw = u.dot(w);
  const double determinant = uu * ww - uw * uw;
  double s = 0.5;
  if (determinant > 1e-9 * uu * ww)
    s = std::clamp((uw * w.dot(r) - ww * u.dot(r)) / determinant, 0.0, 1.0);
  const double t = std::clamp((w.dot(r) + s * uw) / ww, 0.0, 1.0);
  return 0.5 * (a[0] + s * u + b[0] + t * w);
}

}  // namespace

Vector3 deepestPoint(const SupportFace& a, const SupportFace& b, const Vector3& n,
                     double distance) {
  if (b.count == 1) return b[0] - n * (0.5 * distance);
  if (a.count == 1) return a[0] + n * (0.5 * distance);
  if (a.count == 2 && b.count == 2) return betweenLines(a, b);
  // The corner that reaches farthest, of either face.
  const auto extreme = [&](const SupportFace& face, double sign) {
    return *std::max_element(
        face.points.begin(), face.points.begin() + face.count,
        [&](const Vector3& x, const Vector3& y) { return sign * n.dot(x) < sign * n.dot(y); });
  };
  return a.count > b.count ? Vector3(extreme(b, -1.0) - n * (0.5 * distance))
                           : Vector3(extreme(a, 1.0) + n * (0.5 * distance));
}

Collider makeCollider(const Shape& shape, const ConvexHull* hull) {
  Collider c;
  c.convex = {&shape, hull};
  c.boxHalfExtents = localHalfExtents(shape, hull);
  if (hull != nullptr) c.boxCentre = hull->centre;
  return c;
}

namespace {

/// Shapes that touch in one point, whatever the normal.
bool isPointed(const Shape& shape) {
  return shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::ellipsoid;
}

/// The best of a direction and the normals of the faces that it meets. A sphere or an ellipsoid
/// takes the best.
Separation withFaces(const Collider& a, const Transform& X_WA, const Collider& b,
                     const Transform& X_WB, Separation best, double size) {
  const bool isPoint = isPointed(*a.convex.shape) || isPointed(*b.convex.shape);
  double preference = isPoint ? 0.0 : kFacePreference * size;
  const Vector3 faceA = supportFaceNormal(a.convex, X_WA, best.n_W);
  const Vector3 faceB = -supportFaceNormal(b.convex, X_WB, -best.n_W);
  for (const Vector3& face : {faceA, faceB}) {
    if (face.isZero(0.0)) continue;
    const double separation = separationAlong(a.convex, X_WA, b.convex, X_WB, face);
    if (separation < best.distance - preference) continue;
    best = {face, separation};
    preference = 0.0;
  }
  return best;
}

void addManifold(const Collider& a, const Transform& X_WA, const Collider& b, const Transform& X_WB,
                 const Separation& s, double margin, PairContacts& out) {
  const SupportFace supportA = supportFace(a.convex, X_WA, s.n_W);
  const SupportFace supportB = supportFace(b.convex, X_WB, -s.n_W);
  const PairContact deepest{deepestPoint(supportA, supportB, s.n_W, s.distance), s.n_W, s.distance};
  addFaceContacts(supportA, supportB, deepest, margin, out);
}

}  // namespace

Separation separate(const Collider& a, const Transform& X_WA, const Collider& b,
                    const Transform& X_WB, double margin) {
  // Boxes around the shapes that are apart settle most pairs.
  const Transform boxA{X_WA.R, X_WA * a.boxCentre}, boxB{X_WB.R, X_WB * b.boxCentre};
  const BoxSeparation boxes = separateBoxes(a.boxHalfExtents, boxA, b.boxHalfExtents, boxB, margin);
  if (boxes.distance >= margin) return {boxes.n_W, boxes.distance};

  const double size = std::min(a.boxHalfExtents.maxCoeff(), b.boxHalfExtents.maxCoeff());
  const double radii = coreRadius(*a.convex.shape) + coreRadius(*b.convex.shape);
  const SeparatingDirection found =
      separatingDirection(a.convex, X_WA, b.convex, X_WB, size, margin + radii);

  const double distance = found.separation - radii;
  if (!std::isfinite(distance)) return {found.n_W, std::numeric_limits<double>::quiet_NaN()};
  if (distance >= margin) return {found.n_W, distance};
  return withFaces(a, X_WA, b, X_WB, {found.n_W, distance}, size);
}

bool convexConvex(const Collider& a, const Transform& X_WA, const Collider& b,
                  const Transform& X_WB, double margin, PairContacts& out) {
  const auto [n, distance] = separate(a, X_WA, b, X_WB, margin);
  if (std::isnan(distance)) return false;
  if (distance >= margin) return true;

  addManifold(a, X_WA, b, X_WB, {n, distance}, margin, out);
  return true;
}

void convexAlong(const Collider& a, const Transform& X_WA, const Collider& b, const Transform& X_WB,
                 const Vector3& n_W, double margin, PairContacts& out) {
  const double size = std::min(a.boxHalfExtents.maxCoeff(), b.boxHalfExtents.maxCoeff());
  const double distance = separationAlong(a.convex, X_WA, b.convex, X_WB, n_W);
  const Separation best = withFaces(a, X_WA, b, X_WB, {n_W, distance}, size);
  if (best.distance < margin) addManifold(a, X_WA, b, X_WB, best, margin, out);
}

}  // namespace softgauss::collision::detail

// SPDX-License-Identifier: Apache-2.0
#include "collision/detail/convex_pairs.hpp"

#include <algorithm>

#include "collision/box_pairs.hpp"
#include "collision/manifold.hpp"

namespace softgauss::collision::detail {
namespace {

/// A face normal is preferred to the free direction up to this loss of separation, relative to
/// size.
constexpr double kFacePreference = 1e-6;
/// How far touching cores are pushed into each other, relative to the smaller one.
constexpr double kPush = 1e-2;

Vector3 localHalfExtents(const Shape& s, const ConvexHull* hull) {
  switch (s.kind) {
    case ShapeKind::sphere:
      return Vector3::Constant(s.radius);
    case ShapeKind::capsule:
      return {s.radius, s.radius, s.radius + s.halfLength};
    case ShapeKind::cylinder:
      return {s.radius, s.radius, s.halfLength};
    case ShapeKind::box:
      return s.halfExtents;
    default:
      return hull->halfExtents;
  }
}

std::optional<CoreDirection> proposeDirection(const Collider& a, const Transform& X_WA,
                                              const Collider& b, const Transform& X_WB) {
  const double size = std::min(a.boxHalfExtents.maxCoeff(), b.boxHalfExtents.maxCoeff());
  if (const auto direct = coreDirection(a.fcl, X_WA, b.fcl, X_WB, size)) return direct;
  Vector3 apart = X_WB * b.boxCentre - X_WA * a.boxCentre;
  if (apart.norm() < 1e-12) apart = X_WA.R.col(2);
  Transform pushed = X_WB;
  pushed.p -= apart.normalized() * (kPush * size);
  return coreDirection(a.fcl, X_WA, b.fcl, pushed, size);
}

}  // namespace

Collider makeCollider(const Shape& shape, const ConvexHull* hull) {
  Collider c;
  c.convex = {&shape, hull};
  c.boxHalfExtents = localHalfExtents(shape, hull);
  if (hull != nullptr) c.boxCentre = hull->centre;
  c.fcl = FclShape(c.convex);
  return c;
}

bool convexConvex(const Collider& a, const Transform& X_WA, const Collider& b,
                  const Transform& X_WB, double margin, PairContacts& out) {
  // Boxes around the shapes that are apart settle most pairs.
  const Transform boxA{X_WA.R, X_WA * a.boxCentre}, boxB{X_WB.R, X_WB * b.boxCentre};
  if (separateBoxes(a.boxHalfExtents, boxA, b.boxHalfExtents, boxB, margin).distance >= margin)
    return true;

  const auto proposal = proposeDirection(a, X_WA, b, X_WB);
  if (!proposal) return false;

  // The best of the proposed direction and the normals of the faces that it meets.
  Vector3 n = proposal->n_W;
  double distance = separationAlong(a.convex, X_WA, b.convex, X_WB, n);
  const double size = std::min(a.boxHalfExtents.maxCoeff(), b.boxHalfExtents.maxCoeff());
  double preference = kFacePreference * size;
  const Vector3 faceA = supportFaceNormal(a.convex, X_WA, proposal->n_W);
  const Vector3 faceB = -supportFaceNormal(b.convex, X_WB, -proposal->n_W);
  for (const Vector3& face : {faceA, faceB}) {
    if (face.isZero(0.0)) continue;
    const double separation = separationAlong(a.convex, X_WA, b.convex, X_WB, face);
    if (separation < distance - preference) continue;
    n = face;
    distance = separation;
    preference = 0.0;
  }
  if (distance >= margin) return true;

  const SupportFace supportA = supportFace(a.convex, X_WA, n);
  const SupportFace supportB = supportFace(b.convex, X_WB, -n);
  PairContact deepest{proposal->p_W, n, distance};
  if (supportB.count == 1)
    deepest.p_WC = supportB[0] - n * (0.5 * distance);
  else if (supportA.count == 1)
    deepest.p_WC = supportA[0] + n * (0.5 * distance);
  addFaceContacts(supportA, supportB, deepest, margin, out);
  return true;
}

}  // namespace softgauss::collision::detail

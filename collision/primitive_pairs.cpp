// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/primitive_pairs.hpp"

#include "softgauss/collision/box_pairs.hpp"
#include "softgauss/collision/plane_pairs.hpp"
#include "softgauss/collision/round_pairs.hpp"
#include "softgauss/engine/core/check.hpp"

namespace softgauss::collision {
namespace {

constexpr int pairOf(ShapeKind a, ShapeKind b) {
  return static_cast<int>(a) * 8 + static_cast<int>(b);
}

}  // namespace

bool hasClosedForm(ShapeKind a, ShapeKind b) {
  if (b < a) return hasClosedForm(b, a);
  switch (a) {
    case ShapeKind::plane:
      return b != ShapeKind::plane && b != ShapeKind::triangles;
    case ShapeKind::sphere:
      return b < ShapeKind::ellipsoid;
    case ShapeKind::capsule:
      return b == ShapeKind::capsule || b == ShapeKind::box;
    case ShapeKind::box:
      return b == ShapeKind::box;
    default:
      return false;
  }
}

void collideInOrder(const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                    const ConvexHull* hullB, double margin, PairContacts& out) {
  using enum ShapeKind;
  switch (pairOf(a.kind, b.kind)) {
    case pairOf(plane, sphere):
      return planeSphere(X_WA, b, X_WB, margin, out);
    case pairOf(plane, capsule):
      return planeCapsule(X_WA, b, X_WB, margin, out);
    case pairOf(plane, cylinder):
      return planeCylinder(X_WA, b, X_WB, margin, out);
    case pairOf(plane, box):
      return planeBox(X_WA, b, X_WB, margin, out);
    case pairOf(plane, ellipsoid):
      return planeEllipsoid(X_WA, b, X_WB, margin, out);
    case pairOf(plane, mesh):
      return planeHull(X_WA, *hullB, X_WB, margin, out);
    case pairOf(sphere, sphere):
      return sphereSphere(a, X_WA, b, X_WB, margin, out);
    case pairOf(sphere, capsule):
      return sphereCapsule(a, X_WA, b, X_WB, margin, out);
    case pairOf(sphere, cylinder):
      return sphereCylinder(a, X_WA, b, X_WB, margin, out);
    case pairOf(sphere, box):
      return sphereBox(a, X_WA, b, X_WB, margin, out);
    case pairOf(capsule, capsule):
      return capsuleCapsule(a, X_WA, b, X_WB, margin, out);
    case pairOf(capsule, box):
      return capsuleBox(a, X_WA, b, X_WB, margin, out);
    case pairOf(box, box):
      return boxBox(a, X_WA, b, X_WB, margin, out);
    default:
      break;
  }
  SOFTGAUSS_ASSERT(hasClosedForm(a.kind, b.kind) && a.kind <= b.kind);
}

void collidePrimitives(const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                       double margin, PairContacts& out) {
  if (a.kind <= b.kind) return collideInOrder(a, X_WA, b, X_WB, nullptr, margin, out);
  collideInOrder(b, X_WB, a, X_WA, nullptr, margin, out);
  out.flip();
}

}  // namespace softgauss::collision

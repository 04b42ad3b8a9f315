// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/nearest_points.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/collision/detail/minkowski.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::collision::detail {
namespace {

constexpr int kMostSteps = 64;
/// Sine below which a direction counts as across another, and share of a shape below which an edge
/// is none.
constexpr double kAcross = 1e-6;

/// A simplex of D, with the points of A and B that each corner comes from, about A's origin.
struct Carried {
  Simplex simplex;
  std::array<Vector3, 4> a, b;

  bool has(const Vector3& w) const {
    return std::any_of(simplex.points.begin(), simplex.points.begin() + simplex.count,
                       [&](const Vector3& x) { return x == w; });
  }
  void add(const Vector3& ofA, const Vector3& ofB) {
    a[idx(simplex.count)] = ofA;
    b[idx(simplex.count)] = ofB;
    simplex.add(ofA - ofB);
  }
  /// Keeps the corners that carry the point nearest to the origin, and returns that point.
  Vector3 reduce() {
    const Carried before = *this;
    const Vector3 v = nearestToOrigin(simplex);
    for (int i = 0; i < simplex.count; ++i)
      for (int k = 0; k < before.simplex.count; ++k)
        if (before.simplex[k] == simplex[i]) {
          a[idx(i)] = before.a[idx(k)];
          b[idx(i)] = before.b[idx(k)];
        }
    return v;
  }
  /// The shares λ of at most three corners in the point nearest to the origin.
  Vector3 shares() const {
    if (simplex.count == 1) return Vector3::UnitX();
    const Vector3 u = simplex[1] - simplex[0];
    if (simplex.count == 2) {
      const double s = std::clamp(-simplex[0].dot(u) / u.squaredNorm(), 0.0, 1.0);
      return {1.0 - s, s, 0.0};
    }
    const Vector3 w = simplex[2] - simplex[0], n = u.cross(w), p = -simplex[0];
    const double area2 = n.squaredNorm();
    const double s = n.dot(p.cross(w)) / area2, t = n.dot(u.cross(p)) / area2;
    return {1.0 - s - t, s, t};
  }
};

/// The directions across n in which the corners of a simplex that are of one shape lie apart: its
/// surface is straight there, but for what is round.
std::array<Vector3, 2> along(const Collider& of, const Transform& X,
                             const std::array<Vector3, 4>& corners, int count, const Vector3& n) {
  std::array<Vector3, 2> result{Vector3::Zero(), Vector3::Zero()};
  if (of.convex.shape->kind == ShapeKind::ellipsoid) return result;
  if (of.convex.shape->kind == ShapeKind::cylinder) {
    if (std::abs(n.dot(X.R.col(2))) < kAcross) result[0] = X.R.col(2);
    return result;
  }
  std::size_t found = 0;
  for (int i = 1; i < count && found < 2; ++i) {
    Vector3 u = corners[idx(i)] - corners[0];
    u -= n * n.dot(u);
    const double length = u.norm();
    if (found == 1) u -= result[0] * result[0].dot(u);
    if (u.norm() <= kAcross * std::max(length, of.boxHalfExtents.maxCoeff())) continue;
    result[found++] = u.normalized();
  }
  return result;
}

}  // namespace

bool nearestPoints(const Collider& a, const Transform& X_WA, const Collider& b,
                   const Transform& X_WB, double enough, NearPoints& found) {
  // About the origin of A, whose distance from the world's is rounding.
  const Transform X_A{X_WA.R, Vector3::Zero()}, X_B{X_WB.R, X_WB.p - X_WA.p};
  const double radiusA = coreRadius(*a.convex.shape), radiusB = coreRadius(*b.convex.shape);
  const double size = std::min(a.boxHalfExtents.maxCoeff(), b.boxHalfExtents.maxCoeff());
  const double touching = 1e-10 * size;
  Vector3 v = X_A * a.boxCentre - X_B * b.boxCentre;
  if (v.squaredNorm() == 0.0) v = X_A.R.col(0);
  Carried carried;
  for (int i = 0; i < kMostSteps; ++i) {
    const double length = v.norm();
    if (!(length > touching)) return false;
    const Vector3 n = -v / length;
    const Vector3 ofA = corePoint(a.convex, X_A, n), ofB = corePoint(b.convex, X_B, -n);
    const double separation = n.dot(ofB - ofA);
    if (separation - radiusA - radiusB >= enough) {
      found.distance = separation - radiusA - radiusB;
      return true;
    }
    // v is nearest when no point of D lies farther towards the origin.
    if (carried.simplex.count > 0 &&
        (length - separation <= 1e-10 * length || carried.has(ofA - ofB)))
      break;
    carried.add(ofA, ofB);
    v = carried.reduce();
    if (carried.simplex.count == 4) return false;
  }
  const double length = v.norm();
  if (!std::isfinite(length) || !(length > touching) || carried.simplex.count == 0) return false;
  const Vector3 lambda = carried.shares(), n = -v / length;
  Vector3 nearA = Vector3::Zero(), nearB = Vector3::Zero();
  for (int i = 0; i < carried.simplex.count; ++i) {
    nearA += lambda[i] * carried.a[idx(i)];
    nearB += lambda[i] * carried.b[idx(i)];
  }
  found.n_W = n;
  found.alongA = along(a, X_WA, carried.a, carried.simplex.count, n);
  found.alongB = along(b, X_WB, carried.b, carried.simplex.count, n);
  found.distance = length - radiusA - radiusB;
  found.p_WA = X_WA.p + nearA + radiusA * n;
  found.p_WB = X_WA.p + nearB - radiusB * n;
  return true;
}

}  // namespace softgauss::collision::detail

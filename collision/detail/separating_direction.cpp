// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/separating_direction.hpp"

#include <algorithm>

#include "softgauss/collision/detail/minkowski.hpp"

namespace softgauss::collision::detail {
namespace {

constexpr int kMaxIterations = 64;

/// Nearest point to the origin on the segment ab; keeps what carries it.
Vector3 onSegment(const Vector3& a, const Vector3& b, Simplex& kept) {
  const Vector3 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0.0 ? -a.dot(ab) / length2 : 0.0;
  kept.count = 0;
  if (t <= 0.0 || t >= 1.0) {
    kept.add(t <= 0.0 ? a : b);
    return kept[0];
  }
  kept.add(a);
  kept.add(b);
  return a + t * ab;
}

/// The same on the triangle abc: in its interior when the origin lies above all three edges.
Vector3 onTriangle(const Vector3& a, const Vector3& b, const Vector3& c, Simplex& kept) {
  const Vector3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  const auto inside = [&](const Vector3& from, const Vector3& to) {
    return normal.dot((to - from).cross(-from)) >= 0.0;
  };
  if (area2 > 0.0 && inside(a, b) && inside(b, c) && inside(c, a)) {
    kept.count = 0;
    for (const Vector3& x : {a, b, c}) kept.add(x);
    return normal * (normal.dot(a) / area2);
  }
  Vector3 best = onSegment(a, b, kept);
  for (const auto& [p, q] : {std::pair(b, c), std::pair(c, a)}) {
    Simplex other;
    const Vector3 v = onSegment(p, q, other);
    if (v.squaredNorm() < best.squaredNorm()) best = v, kept = other;
  }
  return best;
}

/// The same on the tetrahedron; zero when the origin is inside.
Vector3 onTetrahedron(const Simplex& s, Simplex& kept) {
  static constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}};
  bool outside = false;
  Vector3 best = Vector3::Zero();
  for (const auto& f : kFaces) {
    const Vector3 &a = s[f[0]], &b = s[f[1]], &c = s[f[2]], &opposite = s[f[3]];
    const Vector3 normal = (b - a).cross(c - a);
    const double height = normal.dot(opposite - a);
    // A flat tetrahedron has no inside: all its faces are tried.
    if (height != 0.0 && normal.dot(-a) * height >= 0.0) continue;
    Simplex other;
    const Vector3 v = onTriangle(a, b, c, other);
    if (!outside || v.squaredNorm() < best.squaredNorm()) best = v, kept = other;
    outside = true;
  }
  if (!outside) kept = s;
  return best;
}

}  // namespace

Vector3 nearestToOrigin(Simplex& simplex) {
  const Simplex s = simplex;
  switch (s.count) {
    case 1:
      return s[0];
    case 2:
      return onSegment(s[0], s[1], simplex);
    case 3:
      return onTriangle(s[0], s[1], s[2], simplex);
    default:
      return onTetrahedron(s, simplex);
  }
}

SeparatingDirection separatingDirection(const Convex& a, const Transform& X_WA, const Convex& b,
                                        const Transform& X_WB, double size, double enough) {
  Minkowski D(a, X_WA, b, X_WB, enough);
  Vector3 v = X_WA.p - X_WB.p;
  if (v.squaredNorm() == 0.0) v = X_WA.R.col(0);
  Simplex simplex;
  const double touching = 1e-10 * size;
  for (int i = 0; i < kMaxIterations; ++i) {
    const double length = v.norm();
    if (!(length > touching)) break;
    const Vector3 w = D.support(-v / length);
    if (D.foundEnough()) return D.best();
    // v is nearest when no point of D lies farther towards the origin.
    const double progress = length - v.dot(w) / length;
    if (simplex.count > 0 && progress <= 1e-10 * length) return D.best();
    for (int k = 0; k < simplex.count; ++k)
      if (simplex[k] == w) return D.best();
    simplex.add(w);
    v = nearestToOrigin(simplex);
    if (simplex.count == 4) break;
  }
  expandPolytope(D, simplex, size);
  return D.best();
}

}  // namespace softgauss::collision::detail

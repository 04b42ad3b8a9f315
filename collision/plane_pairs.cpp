// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/plane_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "softgauss/collision/contact_reduction.hpp"
#include "softgauss/collision/support.hpp"

namespace softgauss::collision {
namespace {

/// Contact of a plane through p with unit normal n and the point x of B.
void addPoint(const Vector3& n, const Vector3& p, const Vector3& x, double margin,
              PairContacts& out) {
  const double distance = n.dot(x - p);
  if (distance < margin) out.add(x - n * (0.5 * distance), n, distance);
}

/// Contact of the plane and a sphere at c.
void addSphere(const Vector3& n, const Vector3& p, const Vector3& c, double radius, double margin,
               PairContacts& out) {
  const double distance = n.dot(c - p) - radius;
  if (distance < margin) out.add(c - n * (radius + 0.5 * distance), n, distance);
}

}  // namespace

void planeSphere(const Transform& X_WA, const Shape& sphere, const Transform& X_WB, double margin,
                 PairContacts& out) {
  addSphere(X_WA.R.col(2), X_WA.p, X_WB.p, sphere.radius, margin, out);
}

void planeCapsule(const Transform& X_WA, const Shape& capsule, const Transform& X_WB, double margin,
                  PairContacts& out) {
  const Vector3 n = X_WA.R.col(2);
  const Vector3 axis = X_WB.R.col(2);
  const Vector3 reach = axis * capsule.halfLength;
  addSphere(n, X_WA.p, X_WB.p + reach, capsule.radius, margin, out);
  addSphere(n, X_WA.p, X_WB.p - reach, capsule.radius, margin, out);
  out.tangent_W = axis;
}

void planeBox(const Transform& X_WA, const Shape& box, const Transform& X_WB, double margin,
              PairContacts& out) {
  const Vector3 n = X_WA.R.col(2);
  const Vector3 h = box.halfExtents;
  const double centre = n.dot(X_WB.p - X_WA.p);
  const Vector3 rise = (X_WB.R.transpose() * n).cwiseProduct(h);

  // Opposite corners have opposite heights about the centre, so exactly four count as lower.
  for (int i = 0; i < 8; ++i) {
    const Vector3 sign((i & 1) ? 1.0 : -1.0, (i & 2) ? 1.0 : -1.0, (i & 4) ? 1.0 : -1.0);
    const double height = sign.dot(rise);
    if (height > 0.0 || (height == 0.0 && i >= 4)) continue;
    const double distance = centre + height;
    if (distance >= margin) continue;
    out.add(X_WB * sign.cwiseProduct(h) - n * (0.5 * distance), n, distance);
  }
}

void planeCylinder(const Transform& X_WA, const Shape& cylinder, const Transform& X_WB,
                   double margin, PairContacts& out) {
  const Vector3 n = X_WA.R.col(2);
  const Vector3 p = X_WA.p;

  // a points into the plane, u is the steepest descent along the rim.
  Vector3 a = X_WB.R.col(2);
  if (n.dot(a) > 0.0) a = -a;
  Vector3 u = a * n.dot(a) - n;
  const double slope = u.norm();
  if (slope < 1e-15)
    u = X_WB.R.col(0);
  else
    u /= slope;
  const Vector3 lowerDisc = X_WB.p + a * cylinder.halfLength;
  const Vector3 upperDisc = X_WB.p - a * cylinder.halfLength;
  const double r = cylinder.radius;

  addPoint(n, p, lowerDisc + u * r, margin, out);
  addPoint(n, p, upperDisc + u * r, margin, out);
  const Vector3 side = u.cross(a) * (r * std::sqrt(0.75));
  addPoint(n, p, lowerDisc - u * (0.5 * r) + side, margin, out);
  addPoint(n, p, lowerDisc - u * (0.5 * r) - side, margin, out);
}

void planeEllipsoid(const Transform& X_WA, const Shape& ellipsoid, const Transform& X_WB,
                    double margin, PairContacts& out) {
  const Vector3 n = X_WA.R.col(2);
  const Vector3 lowest = supportPoint({&ellipsoid, nullptr}, X_WB, -n);
  addPoint(n, X_WA.p, lowest, margin, out);
}

void planeHull(const Transform& X_WA, const ConvexHull& hull, const Transform& X_WB, double margin,
               PairContacts& out) {
  const Vector3 n = X_WA.R.col(2);
  const Vector3 n_B = X_WB.R.transpose() * n;
  const double offset = n.dot(X_WB.p - X_WA.p);
  const auto distanceOf = [&](int v) {
    return n_B.dot(hull.vertices[static_cast<std::size_t>(v)]) + offset;
  };
  const int lowest = hull.supportVertex(-n_B);
  if (distanceOf(lowest) >= margin) return;

  // On a convex body the vertices below the margin are connected: they are collected from the
  // lowest one outwards. A body sunk too deep for that has all its vertices tried.
  std::array<int, 64> below;
  std::size_t count = 0;
  bool complete = true;
  const auto collect = [&](int v) {
    const auto end = below.begin() + static_cast<std::ptrdiff_t>(count);
    if (distanceOf(v) >= margin || std::find(below.begin(), end, v) != end) return;
    complete = count < below.size();
    if (complete) below[count++] = v;
  };
  collect(lowest);
  for (std::size_t k = 0; k < count && complete; ++k)
    for (int v : hull.neighbours.of(below[k]))
      if (complete) collect(v);
  std::sort(below.begin(), below.begin() + static_cast<std::ptrdiff_t>(count));

  const auto contact = [&](int i) -> PairContact {
    const int v = complete ? below[static_cast<std::size_t>(i)] : i;
    const double distance = distanceOf(v);
    // Points out of reach are dropped by their distance alone.
    if (distance >= margin) return {Vector3::Zero(), n, distance};
    return {X_WB * hull.vertices[static_cast<std::size_t>(v)] - n * (0.5 * distance), n, distance};
  };
  addReduced(n, static_cast<int>(complete ? count : hull.vertices.size()), margin, contact, out);
}

}  // namespace softgauss::collision

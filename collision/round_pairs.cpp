// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/round_pairs.hpp"

#include <cmath>

#include "softgauss/collision/segment_contacts.hpp"

namespace softgauss::collision {
namespace {

/// Below this length [m] a difference of points has no direction.
constexpr double kNoLength = 1e-15;

/// Contact of the spheres of radius rA at x and rB at y; `fallback` where the centres coincide.
PairContact spheres(const Vector3& x, double rA, const Vector3& y, double rB,
                    const Vector3& fallback) {
  const Vector3 gap = y - x;
  const double length = gap.norm();
  const Vector3 n = length < kNoLength ? fallback : Vector3(gap / length);
  const double distance = length - rA - rB;
  return {x + n * (rA + 0.5 * distance), n, distance};
}

/// A unit vector normal to both axes, or x when they are parallel.
Vector3 commonNormal(const Vector3& a, const Vector3& b) {
  const Vector3 n = a.cross(b);
  const double length = n.norm();
  return length < kNoLength ? Vector3(Vector3::UnitX()) : Vector3(n / length);
}

void addIfNear(const PairContact& contact, double margin, PairContacts& out) {
  if (contact.distance < margin) out.add(contact);
}

/// Nearest point to x on the segment c ± L·axis.
Vector3 nearestOnSegment(const Vector3& x, const Vector3& c, const Vector3& axis, double L) {
  return c + axis * std::clamp(axis.dot(x - c), -L, L);
}

}  // namespace

void sphereSphere(const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                  double margin, PairContacts& out) {
  const double reach = a.radius + b.radius + margin;
  if ((X_WB.p - X_WA.p).squaredNorm() >= reach * reach) return;
  addIfNear(spheres(X_WA.p, a.radius, X_WB.p, b.radius, commonNormal(X_WA.R.col(2), X_WB.R.col(2))),
            margin, out);
}

void sphereCapsule(const Shape& sphere, const Transform& X_WA, const Shape& capsule,
                   const Transform& X_WB, double margin, PairContacts& out) {
  const Vector3 y = nearestOnSegment(X_WA.p, X_WB.p, X_WB.R.col(2), capsule.halfLength);
  const double reach = sphere.radius + capsule.radius + margin;
  if ((y - X_WA.p).squaredNorm() >= reach * reach) return;
  addIfNear(
      spheres(X_WA.p, sphere.radius, y, capsule.radius, commonNormal(X_WA.R.col(2), X_WB.R.col(2))),
      margin, out);
}

void sphereCylinder(const Shape& sphere, const Transform& X_WA, const Shape& cylinder,
                    const Transform& X_WB, double margin, PairContacts& out) {
  const Vector3 axis = X_WB.R.col(2);
  const Vector3 c = X_WA.p - X_WB.p;
  const double z = axis.dot(c);
  const Vector3 lateral = c - axis * z;
  const double rho = lateral.norm();
  const Vector3 radial = rho < kNoLength ? Vector3(X_WB.R.col(0)) : Vector3(lateral / rho);
  const double side = z < 0.0 ? -1.0 : 1.0;
  const double overCap = std::abs(z) - cylinder.halfLength;
  const double overSide = rho - cylinder.radius;

  // Outward direction and signed distance of the centre from the cylinder.
  Vector3 outward;
  double height = 0.0;
  if (overCap <= 0.0 || overSide <= 0.0) {
    const bool cap = overCap > overSide;
    outward = cap ? Vector3(axis * side) : radial;
    height = cap ? overCap : overSide;
  } else {
    height = std::hypot(overCap, overSide);
    outward = (axis * (side * overCap) + radial * overSide) / height;
  }
  const double distance = height - sphere.radius;
  if (distance < margin)
    out.add(X_WA.p - outward * (sphere.radius + 0.5 * distance), -outward, distance);
}

void capsuleCapsule(const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                    double margin, PairContacts& out) {
  const Vector3 u = X_WA.R.col(2), w = X_WB.R.col(2);
  const Vector3 cA = X_WA.p, cB = X_WB.p;
  const double LA = a.halfLength, LB = b.halfLength;
  const Vector3 r = cA - cB;
  const double cosine = u.dot(w);

  // Nearest points x = cA + s u, y = cB + t w of the two lines, clamped to the segments in turn.
  // The part of u across w gives the sine without cancellation.
  const Vector3 across = u - w * cosine;
  const double sine2 = across.squaredNorm();
  double s = sine2 > 1e-30 ? std::clamp(-across.dot(r) / sine2, -LA, LA) : 0.0;
  double t = w.dot(r) + s * cosine;
  if (std::abs(t) > LB) {
    t = std::copysign(LB, t);
    s = std::clamp(t * cosine - u.dot(r), -LA, LA);
  }
  const Vector3 x = cA + u * s, y = cB + w * t;
  const double reach = a.radius + b.radius + margin;
  if ((y - x).squaredNorm() >= reach * reach) return;

  const Vector3 fallback = commonNormal(u, w);
  const PairContact nearest = spheres(x, a.radius, y, b.radius, fallback);
  double lambda = alongside(sine2);
  if (lambda == 0.0) {
    addIfNear(nearest, margin, out);
    return;
  }

  // Both segments on the mean direction m, from B's centre: they lie side by side on [low, high].
  const double turn = std::copysign(1.0, cosine);
  const Vector3 m = (u + w * turn).normalized();
  const double mr = m.dot(r), LAm = LA * m.dot(u), LBm = LB * std::abs(m.dot(w));
  const bool lowOnA = mr - LAm > -LBm, highOnA = mr + LAm < LBm;
  const double low = lowOnA ? mr - LAm : -LBm;
  const double high = highOnA ? mr + LAm : LBm;
  const double shortest = 0.5 * std::min(a.radius, b.radius);
  lambda *= std::clamp((high - low) / std::max(shortest, kNoLength), 0.0, 1.0);
  if (lambda == 0.0) {
    addIfNear(nearest, margin, out);
    return;
  }

  // At each end one of the segments ends; the other is met at its nearest point.
  const auto end = [&](bool onA, double sign) {
    if (onA) {
      const Vector3 tip = cA + u * (sign * LA);
      return spheres(tip, a.radius, nearestOnSegment(tip, cB, w, LB), b.radius, fallback);
    }
    const Vector3 tip = cB + w * (sign * turn * LB);
    return spheres(nearestOnSegment(tip, cA, u, LA), a.radius, tip, b.radius, fallback);
  };
  const double place = 0.5 * (m.dot(x - cB) + m.dot(y - cB));
  const double fraction = std::clamp((place - low) / (high - low), 0.0, 1.0);
  addSegmentContacts(nearest, end(lowOnA, -1.0), end(highOnA, 1.0), fraction, lambda, margin, out);
}

}  // namespace softgauss::collision

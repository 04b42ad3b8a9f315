// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Thins many contact points with a common normal to four that support as well.
///
/// Pressure can rest anywhere in the convex hull of the contact points, so few points serve as well
/// as many when they keep the deepest one and span nearly the same area:
///   1. the deepest point a,
///   2. b farthest from a along the contact plane,
///   3. c farthest from the line ab,
///   4. d that enlarges the triangle abc most.
/// The choice depends on the points and their order alone; ties, to within rounding, go to the
/// earlier point.

#include <algorithm>
#include <cmath>

#include "softgauss/collision/pair_contact.hpp"

namespace softgauss::collision {

/// Adds at most four of the points contact(0 … count − 1) whose distance < margin to `out`.
/// contact(i) returns a PairContact and is called up to four times for each i, which costs less
/// than storing the points. `n` is the common normal.
template <class ContactAt>
void addReduced(const Vector3& n, int count, double margin, ContactAt&& contact,
                PairContacts& out) {
  const auto forTouching = [&](auto&& visit) {
    for (int i = 0; i < count; ++i) {
      const PairContact candidate = contact(i);
      if (candidate.distance < margin) visit(candidate);
    }
  };
  constexpr double kClearly = 1.0 + 1e-9;
  const auto lateral = [&](const Vector3& x) -> Vector3 { return x - n * n.dot(x); };

  int touching = 0;
  PairContact a{};
  forTouching([&](const PairContact& x) {
    if (touching++ == 0 || x.distance < a.distance) a = x;
  });
  if (touching <= 4) {
    forTouching([&](const PairContact& x) { out.add(x); });
    return;
  }

  PairContact b = a;
  double farthest = 0.0;
  forTouching([&](const PairContact& x) {
    const double d = lateral(x.p_WC - a.p_WC).squaredNorm();
    if (d > farthest * kClearly) farthest = d, b = x;
  });
  out.add(a);
  if (farthest == 0.0) return;
  out.add(b);

  // Twice the signed area of a triangle in the contact plane.
  const auto area = [&](const Vector3& x, const Vector3& y, const Vector3& z) {
    return n.dot((y - x).cross(z - x));
  };
  const double negligible = 1e-12 * farthest;
  PairContact c = a;
  double largest = 0.0;
  forTouching([&](const PairContact& x) {
    const double s = area(a.p_WC, b.p_WC, x.p_WC);
    if (std::abs(s) > std::abs(largest) * kClearly) largest = s, c = x;
  });
  if (std::abs(largest) <= negligible) return;
  out.add(c);

  // Outside an edge the area has the sign opposite to that of the triangle.
  const double side = largest > 0.0 ? -1.0 : 1.0;
  PairContact d = a;
  double gain = negligible;
  forTouching([&](const PairContact& x) {
    const double s =
        std::max({side * area(a.p_WC, b.p_WC, x.p_WC), side * area(b.p_WC, c.p_WC, x.p_WC),
                  side * area(c.p_WC, a.p_WC, x.p_WC)});
    if (s > gain * kClearly) gain = s, d = x;
  });
  if (gain > negligible) out.add(d);
}

}  // namespace softgauss::collision

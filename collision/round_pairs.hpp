// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Spheres and capsules against each other and against a cylinder, in closed form.
///
/// A sphere is a point with a radius, a capsule a segment with a radius. With x on the core of A
/// and y on that of B nearest to each other,
///   n = (y − x)/|y − x|,   d = |y − x| − r_A − r_B,   p = x + n (r_A + d/2).
/// Coinciding centres have no direction; n is then a fixed one, chosen from the axes.
///
/// Two capsules: the nearest points jump from end to end as parallel axes turn through each other,
/// which makes one contact rattle. Nearly parallel capsules therefore touch at both ends of the
/// interval in which they lie side by side, see segment_contacts.hpp; the blend is continuous in
/// the poses and the single nearest pair away from parallel.

#include "softgauss/collision/pair_contact.hpp"
#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/model/shape.hpp"

namespace softgauss::collision {

void sphereSphere(const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                  double margin, PairContacts& out);
void sphereCapsule(const Shape& sphere, const Transform& X_WA, const Shape& capsule,
                   const Transform& X_WB, double margin, PairContacts& out);
void sphereCylinder(const Shape& sphere, const Transform& X_WA, const Shape& cylinder,
                    const Transform& X_WB, double margin, PairContacts& out);
void capsuleCapsule(const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                    double margin, PairContacts& out);

}  // namespace softgauss::collision

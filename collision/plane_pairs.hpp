// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A half-space A against every other shape B, in closed form.
///
/// The plane has the normal n = z axis of A and passes its origin p. A point x of B is at the
/// distance d = n·(x − p), and its contact is at x − n d/2 (surface of the plane: x − n d). Each
/// shape offers the points on which it can rest:
///   sphere     c − n r
///   capsule    both ends, +z end first; first tangent along the capsule
///   box        the four corners below its centre, in the order of their sign bits (x lowest)
///   cylinder   lowest point of the lower rim and of the upper rim, and two more of the lower rim
///              at ±120° from the first, so that a disc lying flat stands on a regular triangle
///   ellipsoid  its lowest point
///   hull       the vertices below the margin, thinned to four by addReduced()
/// Points with d < margin are reported. Same points and order as MuJoCo's for the primitives.

#include "softgauss/collision/convex_hull.hpp"
#include "softgauss/collision/pair_contact.hpp"
#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/model/shape.hpp"

namespace softgauss::collision {

void planeSphere(const Transform& X_WA, const Shape& sphere, const Transform& X_WB, double margin,
                 PairContacts& out);
void planeCapsule(const Transform& X_WA, const Shape& capsule, const Transform& X_WB, double margin,
                  PairContacts& out);
void planeBox(const Transform& X_WA, const Shape& box, const Transform& X_WB, double margin,
              PairContacts& out);
void planeCylinder(const Transform& X_WA, const Shape& cylinder, const Transform& X_WB,
                   double margin, PairContacts& out);
void planeEllipsoid(const Transform& X_WA, const Shape& ellipsoid, const Transform& X_WB,
                    double margin, PairContacts& out);
void planeHull(const Transform& X_WA, const ConvexHull& hull, const Transform& X_WB, double margin,
               PairContacts& out);

}  // namespace softgauss::collision

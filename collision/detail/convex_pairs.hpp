// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Pairs of convex shapes that have no closed form: hulls, and cylinders against boxes, capsules
/// and cylinders.
///
/// GJK and EPA propose a direction (separating_direction.hpp). The normals of the two faces met
/// along it are tried as well, and of these the one with the largest separation σ(n) is the normal,
/// so that two faces that rest on each other share an exact normal. The distance is σ(n), and the
/// manifold comes from the support faces.

#include "softgauss/collision/pair_contact.hpp"
#include "softgauss/collision/support.hpp"

namespace softgauss::collision::detail {

/// A convex shape and a box around it.
struct Collider {
  Convex convex;
  Vector3 boxCentre = Vector3::Zero();       ///< in G [m]
  Vector3 boxHalfExtents = Vector3::Zero();  ///< along the axes of G [m]
};

/// `shape` and `hull` must outlive the result.
Collider makeCollider(const Shape& shape, const ConvexHull* hull);

/// How two shapes lie to each other.
struct Separation {
  Vector3 n_W = Vector3::UnitZ();  ///< unit, from A to B
  double distance = kInfinity;     ///< σ(n) [m]; NaN where a pose is not finite
};

/// The direction of the largest separation that is found; where it is `margin` or more, any
/// direction with that.
Separation separate(const Collider& a, const Transform& X_WA, const Collider& b,
                    const Transform& X_WB, double margin);

/// Where shapes at `distance` along the unit vector n touch whose support faces, of A along n and
/// of B along −n, have no common area.
Vector3 deepestPoint(const SupportFace& faceA, const SupportFace& faceB, const Vector3& n,
                     double distance);

/// Adds the contacts of two shapes that overlap, along the unit vector n_W from A to B or the
/// normal of one of the faces that it meets, whichever overlaps least.
void convexAlong(const Collider& a, const Transform& X_WA, const Collider& b, const Transform& X_WB,
                 const Vector3& n_W, double margin, PairContacts& out);

/// Returns false when a pose is not finite, so that nothing is known about the pair.
bool convexConvex(const Collider& a, const Transform& X_WA, const Collider& b,
                  const Transform& X_WB, double margin, PairContacts& out);

}  // namespace softgauss::collision::detail

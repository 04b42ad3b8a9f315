// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Pairs of convex shapes that have no closed form: hulls, and cylinders against boxes, capsules
/// and cylinders.
///
/// FCL (GJK, EPA) proposes a direction. The normals of the two faces met along it are tried as
/// well, and of these the one with the largest separation σ(n) is the normal, so that two faces
/// that rest on each other share an exact normal. Its distance is σ(n), computed from the support
/// points of the two shapes and not taken from FCL; the manifold comes from the support faces.
/// Where the cores touch exactly, the direction is that of the cores pushed into each other a
/// little.

#include "collision/detail/fcl_query.hpp"
#include "collision/pair_contact.hpp"
#include "collision/support.hpp"

namespace softgauss::collision::detail {

/// A convex shape ready for any query.
struct Collider {
  Convex convex;
  FclShape fcl;                              ///< set where a pair without closed form may need it
  Vector3 boxCentre = Vector3::Zero();       ///< of a box around the shape, in G [m]
  Vector3 boxHalfExtents = Vector3::Zero();  ///< of that box
};

/// `shape` and `hull` must outlive the result.
Collider makeCollider(const Shape& shape, const ConvexHull* hull);

/// Returns false when the query failed and nothing is known about the pair.
bool convexConvex(const Collider& a, const Transform& X_WA, const Collider& b,
                  const Transform& X_WB, double margin, PairContacts& out);

}  // namespace softgauss::collision::detail

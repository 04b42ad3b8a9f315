// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Boxes against spheres, capsules and boxes, in closed form.
///
/// Sphere: with c its centre in the box's frame and q = c clamped to the box, the normal is along
/// q − c; a centre inside the box leaves through the nearest face.
///
/// Capsule: on its segment x(t) = c + t u the squared distance to the box is convex and piecewise
/// quadratic, Σᵢ max(|xᵢ| − hᵢ, 0)², with at most six breakpoints, so its minimum is exact. A
/// capsule lying along a face or an edge also touches at both ends of the stretch over it, see
/// segment_contacts.hpp. A segment that cuts the box leaves along the separating axis of least
/// overlap: a face normal, shared by all points, or the product of the segment and an edge.
///
/// Box: the separating-axis theorem gives the axis of largest separation σ among the 3 + 3 face
/// normals and the 9 products of edges. A product of edges is taken only when it is clearly better
/// than every face, so that a resting face does not flicker. A face gives up to four corners of the
/// clipped faces, see manifold.hpp; two edges give their nearest points. Between disjoint boxes σ
/// may be less than their distance, where corners face each other.

#include "softgauss/collision/pair_contact.hpp"
#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/model/shape.hpp"

namespace softgauss::collision {

void sphereBox(const Shape& sphere, const Transform& X_WA, const Shape& box, const Transform& X_WB,
               double margin, PairContacts& out);
void capsuleBox(const Shape& capsule, const Transform& X_WA, const Shape& box,
                const Transform& X_WB, double margin, PairContacts& out);
void boxBox(const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
            double margin, PairContacts& out);

/// An axis that separates two oriented boxes best.
struct BoxSeparation {
  Vector3 n_W = Vector3::UnitZ();  ///< unit, from A to B
  double distance = 0.0;           ///< σ(n) [m]
  int edgeA = -1;                  ///< axes of the edges when n is their product, else −1
  int edgeB = -1;
};

/// Largest separation over the 15 axes; returns at the first axis with σ ≥ margin.
BoxSeparation separateBoxes(const Vector3& halfA, const Transform& X_WA, const Vector3& halfB,
                            const Transform& X_WB, double margin);

}  // namespace softgauss::collision

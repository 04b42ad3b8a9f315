// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One entrance to all pairs of shapes that are solved in closed form.
///
/// Shapes are ordered by kind, plane < sphere < capsule < cylinder < box < ellipsoid < mesh
/// < triangles; the lower kind is A, and the normal points from A to B. Closed forms:
///   plane    with every other but triangles (of a mesh its hull)       plane_pairs.hpp
///   sphere   with sphere, capsule, cylinder                            round_pairs.hpp
///   capsule  with capsule                                              round_pairs.hpp
///   box      with sphere, capsule, box                                 box_pairs.hpp
/// Pairs with triangles go through detail/surface_contacts.hpp, the others through
/// detail/convex_pairs.hpp.

#include "softgauss/collision/convex_hull.hpp"
#include "softgauss/collision/pair_contact.hpp"
#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/model/shape.hpp"

namespace softgauss::collision {

/// Whether the pair has a closed form; the order of the kinds does not matter.
bool hasClosedForm(ShapeKind a, ShapeKind b);

/// Contacts of A and B with distance < margin, added to `out`. Requires hasClosedForm() and
/// a.kind ≤ b.kind; `hullB` is read for a mesh only. Allocates nothing.
void collideInOrder(const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                    const ConvexHull* hullB, double margin, PairContacts& out);

/// The same for kinds in any order, without meshes: the normal points from a to b.
void collidePrimitives(const Shape& a, const Transform& X_WA, const Shape& b, const Transform& X_WB,
                       double margin, PairContacts& out);

}  // namespace softgauss::collision

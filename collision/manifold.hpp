// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From one normal to a manifold on which a body can rest.
///
/// Two convex shapes that touch along n (unit, from A to B) do so with the support face of A along
/// n and that of B along −n. Both are projected onto the plane normal to n and clipped against each
/// other; the corners of the common area are points of both surfaces, with the gap
///   d = n·(x_B − x_A)
/// between them measured along n. Since the faces belong to the shapes, d ≥ σ(n) everywhere, and a
/// tilted face offers only the corners that really overlap: nothing is decided by an angle.

#include "softgauss/collision/pair_contact.hpp"
#include "softgauss/collision/support.hpp"

namespace softgauss::collision {

/// Adds at most four contacts with distance < margin. `deepest` is the contact at the support
/// points; it is used where a face is a point, where segments cross, or where no corner is nearly
/// as deep (round shapes). Where polygons have no common area, the contact is between their nearest
/// rims.
void addFaceContacts(const SupportFace& faceA, const SupportFace& faceB, const PairContact& deepest,
                     double margin, PairContacts& out);

}  // namespace softgauss::collision

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How a contact slides, in the masses that it feels: what law/slip.hpp is given.

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/contact.hpp"

namespace softgauss {

/// The inverse weight of a body where it is pushed [1/kg]: that of its centre of mass, if that can
/// move. `turned`: what turns it by a push there, as an inverse weight.
double weightAt(const Assembly& in, int body, double turned);

/// n A/R: what the n rows of a contact answer to a residual along the normal, of what would undo it
/// [-].
double gainOf(const Options& options, const Touch& touch, const Softness& soft);

/// V (5.11) of a contact that moves by `velocity` in its frame.
double slipNumber(const Assembly& in, const Contact& contact, const Touch& touch,
                  const std::array<double, 6>& velocity);

/// Whether friction holds a weight at a contact: gravity asks half of what would take the load off
/// an edge of its pyramid, 1/(condim − 1) of the cone. Contacts of what goals control are left out,
/// for the forces there are the goals' to choose, and of what connections or welds hold, which bear
/// its weight.
bool holdsWeight(const Assembly& in, const Contact& contact, const Touch& touch);

/// What t₁ of a contact is along, besides n.
struct WishedTangent {
  Vector3 t_W;
  bool ofGravity = false;
};

/// A pyramid turns with the slip of its bodies, or, where nothing slides, with their roll, as long
/// as friction turns that stably, slower than it points: friction then points against it, whatever
/// tangents the contact has. Where it holds a weight the pyramid turns with gravity: between its
/// tangents it would hold 71 %.
WishedTangent tangentOf(const Assembly& in, const Contact& contact, const Touch& touch,
                        const Motion& slips_W);

}  // namespace softgauss

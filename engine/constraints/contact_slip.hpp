// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How a contact slides, in the masses that it feels: what law/slip.hpp is given.

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/contact.hpp"

namespace softgauss {

/// The inverse weight of a body at p_W [1/kg]: that of its centre of mass, if that can move.
double weightAt(const Assembly& in, int body, const Vector3& p_W);

/// n A/R: what the n rows of a contact answer to a residual along the normal, of what would undo it
/// [-].
double gainOf(const Options& options, const Touch& touch, const Softness& soft);

/// Whether a pyramid turns with the slip [m/s] of its bodies: where friction turns the slip stably,
/// slower than it points. Friction then points against the slip, whatever tangents the pyramid has.
bool turnsWithSlip(const Assembly& in, const Contact& contact, const Touch& touch,
                   const Vector3& slip_W);

}  // namespace softgauss

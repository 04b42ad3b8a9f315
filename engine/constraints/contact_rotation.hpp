// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How fast the bodies of a contact turn against each other's surface.

#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss {

/// The rate with which normal and lever of a contact change by the turning of its bodies [rad/s]:
/// what turns about the normal, and spheres, leave both as they are; the place where a cylinder's
/// rim touches goes round it.
double contactRotationRate(const Model& model, const Kinematics& kinematics,
                           const Contact& contact);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a joint of one degree of freedom feels when all other joints are held.

#include "softgauss/engine/constraints/assembly.hpp"

namespace softgauss {

/// M_ii of the joint of a body, with armature: the inertia of all that it carries [kg or kg m²].
double supportedInertia(const Assembly& in, int body);

}  // namespace softgauss

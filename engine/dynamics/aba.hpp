// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Articulated-body algorithm (Featherstone 2008, section 7.3): v̇ = M⁻¹(τ − b) in O(n), without
/// forming M. An independent oracle for CRBA, RNEA and the tree factorisation.

#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

/// Unconstrained acceleration for the applied force tau. Allocates; meant for tests and tools.
VectorX articulatedBodyAcceleration(const Model& model, const Kinematics& kinematics,
                                    const MassMatrix& inertia, const VectorX& tau);

}  // namespace softgauss

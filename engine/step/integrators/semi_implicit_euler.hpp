// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Semi-implicit Euler:
///
///   v⁺ = v + h a′,   q⁺ = q ⊕ h v⁺                                                       (7.1)
///
/// with a′ = a of (1.1), whose inertia has joint damping and stiff springs at the step's end
/// (implicit_forces.hpp). Without Options::implicitInSolve they follow the solve,
/// (M + h D) a′ = M a, and the step is MuJoCo's Euler. Order 1. Coriolis and gyroscopic forces are
/// those of the step's start: they feed a body that turns at ω with energy at the relative rate
/// h ω², and fast joints diverge.

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// Reads data.forward, writes data.acceleration and the state. Returns false, with the state
/// untouched, when the result is not finite.
bool semiImplicitEuler(const Model& model, Data& data, State& state);

}  // namespace softgauss

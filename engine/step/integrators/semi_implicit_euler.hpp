// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Semi-implicit Euler with Coriolis forces of mid-step:
///
///   v⁺ = v + h (a + δ),   q⁺ = q ⊕ h v⁺                                               (T.16)
///
/// with a of (T.1), whose inertia has joint damping and stiff springs at the step's end
/// (implicit_forces.hpp). Order 1. δ (Options::midpointCoriolis) takes the Coriolis and gyroscopic
/// forces at the middle of the step, v + ½ h a: M δ = −Δb, and where rows act, what they answer to
/// it (T.123), mid_step.hpp. Taken at its start these forces feed a body that turns at ω with
/// energy at the relative rate h ω², and fast joints diverge. Without δ, and with damping that
/// follows the solve (Options::implicitInSolve), (M + h D) a' = M a, the step is MuJoCo's Euler.
/// Trees that turn far in the step are followed through it (followed_trees.hpp).

#include "engine/step/data.hpp"

namespace softgauss {

/// Reads data.forward, writes data.acceleration and the state. Returns false, with the state
/// untouched, when the result is not finite.
bool semiImplicitEuler(const Model& model, Data& data, State& state);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Semi-implicit Euler with implicit joint damping and Coriolis forces of mid-step (T.16):
///
///   (M + h D) a' = M (a + δ),   v⁺ = v + h a',   q⁺ = q ⊕ h v⁺
///
/// a is the continuous-time acceleration. Damping is taken at v⁺, so any h d is stable; without it
/// and without Coriolis forces a' = a. Order 1. δ (Options::midpointCoriolis) takes the Coriolis
/// and gyroscopic forces at the middle of the step, v + ½ h â with (M + h D) â = M a: M δ = −Δb,
/// and where rows act, what they answer to it (T.123), mid_step.hpp. Taken at its start these
/// forces feed a body that turns at ω with energy at the relative rate h ω², and fast joints
/// diverge. Without δ the step is MuJoCo's Euler. With it, springs that swing by more than a radian
/// in a step, h² k w_i > 1, are taken at its end too: h² K on the left, −h K v on the right (T.95),
/// stable for any k. Slower ones keep their energy and stay as they are. Trees that turn far in the
/// step are followed through it (followed_trees.hpp).

#include "engine/step/data.hpp"

namespace softgauss {

/// Reads data.forward, writes data.acceleration and the state. Returns false, with the state
/// untouched, when the result is not finite.
bool semiImplicitEuler(const Model& model, Data& data, State& state);

}  // namespace softgauss

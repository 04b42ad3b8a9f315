// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Semi-implicit Euler with implicit joint damping (T.16):
///
///   (M + h D) a' = M a,   v⁺ = v + h a',   q⁺ = q ⊕ h v⁺
///
/// a is the continuous-time acceleration; a' is what it becomes when the damping force is taken at
/// v⁺. Without damping a' = a. Order 1; stable for any damping h d.

#include "engine/step/data.hpp"

namespace softgauss {

/// Reads data.forward, writes data.acceleration and the state. Returns false, with the state
/// untouched, when the result is not finite.
bool semiImplicitEuler(const Model& model, Data& data, State& state);

}  // namespace softgauss

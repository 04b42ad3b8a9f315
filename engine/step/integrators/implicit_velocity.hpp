// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Implicit in velocity, the Coriolis derivative included:
///
///   (M + h D + h² K_s + h C) a' = M a − h K_s v,   v⁺ = v + h a',   q⁺ = q ⊕ h v⁺       (7.2)
///
/// a is the continuous-time acceleration (1.1), C = ∂b/∂v (2.9), K_s the stiff springs of
/// (6.1): all smooth forces are taken at v⁺, to first order in what v changes by. Order 1. The
/// matrix is not symmetric. Bodies that spin fast lose energy where the Coriolis forces of mid-step
/// keep it. It is what MuJoCo calls `implicit`. Where the derivative outweighs the mass matrix (h ω
/// far above 1) it is left out of that step.

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// Reads data.forward, writes data.acceleration and the state. Returns false, with the state
/// untouched, when the result is not finite.
bool implicitVelocity(const Model& model, Data& data, State& state);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The implicit midpoint rule with a discrete gradient of the energy
/// (docs/decisions/0029-energy-conserving-midpoint.md):
///
///   v̄ = ½(v + v⁺),   q̄ = q ⊕ ½ h v̄,   q⁺ = q ⊕ h v̄
///   v⁺ = v + h (a(q̄, v̄) + γ v̄),   γ such that  E(q⁺, v⁺) − E(q, v) = h v̄ · Q              (7.3)
///
/// a is forward dynamics (1.1) at the middle with all its rows, E the energy of motion, weight and
/// springs, and Q all other forces there: applied ones, damping, Jᵀf. So the energy changes by the
/// work that is done and by nothing else, contacts included. γ is of O(h²). The rule is symmetric:
/// a step back undoes a step. Order 2.
///
/// The equations are solved by simplified Newton sweeps with M + ½h(D + C) + ¼h²K, C of (2.9), so
/// that damping may be stiff. Where sweeps do not close, the step goes in parts, each of them such
/// a step: StepStats::rejections. At h/64 a part with rows is taken as it is and counted in
/// StepStats::minimumStepsAccepted, for their forces may jump; for no other reason does a step go
/// on that has not closed: SolveStatus::integratorDiverged, and the state stays.

#include "softgauss/engine/step/contact_source.hpp"
#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// Moves the state on by options.timestep. `data` holds the stages at the state and its forward
/// solution; they stay. `input`: what is applied over the step. Returns converged; or
/// integratorDiverged or notFinite, with the state untouched.
SolveStatus implicitMidpoint(const Model& model, const Input& input, ContactSource* contacts,
                             Data& data, State& state) noexcept;

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Drift, solve, drift: the leapfrog, of order 2, with one solve.
///
///   q_m = q ⊕ ½ h v
///   a   = (1.1) at q_m, with rows and damping of v, and with Coriolis forces and J̇ v of
///         v′ = v + ½ h a₋,   a₋ that of the last step
///   v⁺  = v + h a,   q⁺ = q_m ⊕ ½ h v⁺                                                  (6.2)
///
/// Nothing follows the solve, so (v⁺ − v)/h is what was solved, goals included. Forces of position
/// are those of mid-step, and so are Coriolis forces to the order that counts: v and q are of one
/// instant, and a step back undoes a step but for damping and rows. Joint damping and stiff springs
/// are those of the step's end, as inertia of the solve (implicit_forces.hpp); joints on stiff
/// springs do not drift before it, for their springs know where they end. Where a₋ is not known, or
/// has changed so much that a tree ends elsewhere, ½ h² |a − a₋| > kForgets, the solve is repeated
/// with a in its place, and with its forces in the place of f₋ (6.8): a string that comes taut is
/// held in the step in which it does.

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// q ← q_m.
void driftBefore(const Model& model, Data& data, State& state);

/// Whether v′ is known: there was a step before.
bool predictsMidstepVelocity(const Model& model, const State& state);
/// The velocity of turning v′ (6.2), and what depends on it, into data.kinematics.
void predictMidstepVelocity(const Model& model, const State& state, Data& data);

/// Where a tree that is not free ends elsewhere than a₋ has it, or a₋ is not known: state.a ← a,
/// state.connectionForces ← those of its connections, and true.
bool predictionFailed(const Model& model, Data& data, State& state);

/// v⁺ and q⁺ of a state at q_m; writes data.acceleration and the state. Returns false, with the
/// state untouched, when the result is not finite.
bool kickAndDrift(const Model& model, Data& data, State& state);

}  // namespace softgauss

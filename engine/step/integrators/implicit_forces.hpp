// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Joint damping and stiff springs at the end of the step. Of the velocity v⁺ = v + h a and the
/// position q + h v⁺ they are
///
///   D v⁺ + K (q + h v⁺ − q_s)  =  D v + K (q − q_s) + h K v  +  (h D + h² K) a
///
/// so M̂ = M + h D + h² K in place of M, with h K v more in c, makes them part of the solve: (1.1)
/// stays what it is, convex and with an explicit inverse [Anitescu and Potra 2002, of stiff
/// springs]. M itself stays that of the bodies, for whoever weighs and prices by it. A spring is
/// stiff where it swings by more than a radian in a step, h² k w_i > 1 (6.1); slower ones keep
/// their energy and stay as they are.

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// A spring that swings by more than a radian in a step, taken at the step's end.
bool isStiffSpring(const Model& model, const Data& data, const Plan::Spring& spring);
bool anyStiffSpring(const Model& model, const Data& data);

/// Whether there are some that are no part of the solve but follow it.
bool implicitFollows(const Model& model, const Data& data);

/// M̂ ← M + h D + h² K (Options::implicitInSolve).
void addImplicitInertia(const Model& model, Data& data);
/// c ← c + h K v, of the same springs.
void addImplicitForces(const Model& model, const State& state, Data& data);

/// The same for what follows the solve: data.forward.diagonal ← h D + h² K, net ← net − h K v.
void setImplicitForces(const Model& model, const State& state, Data& data, VectorX& net);

}  // namespace softgauss

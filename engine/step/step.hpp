// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One step of the simulation.

#include "engine/step/contact_source.hpp"
#include "engine/step/data.hpp"

namespace softgauss {

/// Everything that a solve needs at (q, v): kinematics, M, smooth forces, contacts, rows.
/// Returns notFinite when the state or the input is not finite, or does not fit the model.
SolveStatus computeStages(const Model& model, const Input& input, const State& state, Data& data,
                          ContactSource* contacts) noexcept;

/// The same where data.kinematics is that of the state already.
SolveStatus computeStagesAt(const Model& model, const Input& input, const State& state, Data& data,
                            ContactSource* contacts) noexcept;

/// forwardDynamics for data.forces.net, then the integrator, which advances the state by
/// options.timestep. `guess` starts the solve (null: none); the result is the next warm start.
/// `held` and `contacts`: what is applied over the whole step, and where contacts come from, for
/// integrators that evaluate the dynamics again within it.
/// On SolveStatus::notFinite and notClosed the state is left as it was.
SolveStatus advance(const Model& model, const Input& held, ContactSource* contacts,
                    const VectorX* guess, Data& data, State& state) noexcept;

/// The largest |realised − solved| over max(|solved|∞, 1): StepStats::realised.
double deviation(const VectorX& realised, const VectorX& solved) noexcept;

/// computeStages, then advance. `contacts` may be null: nothing collides. On
/// SolveStatus::notFinite and notClosed (isRefused()) the state is left as it was, data.stats tells
/// the dof. Other statuses
/// advance the state; data.stats.residual tells how accurate the solve was.
SolveStatus step(const Model& model, const Input& input, State& state, Data& data,
                 ContactSource* contacts) noexcept;

}  // namespace softgauss

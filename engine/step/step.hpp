// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One step of the simulation.

#include "softgauss/engine/step/contact_source.hpp"
#include "softgauss/engine/step/step_control.hpp"

namespace softgauss {

/// Everything that a solve needs at (q, v): kinematics, M, smooth forces, contacts, rows; in the
/// leapfrog with the velocity of turning that State::a predicts. Returns notFinite when the state
/// or the input is not finite, badInput when it does not fit the model.
SolveStatus computeStages(const Model& model, const Input& input, const State& state, Data& data,
                          ContactSource* contacts) noexcept;
/// The same without M and J, which forward and inverse dynamics do not need: in O(n + rows).
SolveStatus computeBodyStages(const Model& model, const Input& input, const State& state,
                              Data& data, ContactSource* contacts) noexcept;

/// One step: the stages; `control`, where there is one, finds the applied force (8); forward
/// dynamics the acceleration (13); the integrator moves the state on by options.timestep (23).
/// `contacts` may be null: nothing collides. `input` acts besides the control. With Options::sleep
/// the stages are of the trees that are awake; those of computeStages() are of all.
/// On SolveStatus::notFinite, integratorDiverged and badInput (isRefused()) the state is left as it
/// was; data.stats tells the dof, or what does not fit the model. Other statuses advance the state;
/// data.stats.residual tells how accurate the solve was.
SolveStatus step(const Model& model, const Input& input, State& state, Data& data,
                 ContactSource* contacts, StepControl* control = nullptr) noexcept;

}  // namespace softgauss

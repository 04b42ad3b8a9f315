// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Explicit Runge–Kutta steps of the continuous-time dynamics, on the manifold of configurations.
///
///   q = q₀ ⊕ φ,   φ̇ = dexp⁻¹_φ(v),   v̇ = a(q, v)                                        (7.5)
///
/// a is forward dynamics (1.1) with all its rows, solved anew in every stage; φ is a displacement
/// from where the step began, and dexp⁻¹ is the identity but for the rotation of floating joints
/// (6.6) [Munthe-Kaas 1999]. It keeps the order in orientation. With ConstraintModel::mujoco,
/// as under `--compatibility mujoco`, the classical method takes φ̇ = v: MuJoCo's averaged rate, of
/// order 2 in orientation. Joint damping is explicit: h d must stay well below M_ii. The applied
/// force is held over the step.
///
/// A method with an error estimate divides the step until each part i, of length h_i, has
/// max |e| ≤ tolerance h_i/h: e of φ [m or rad], and of v times h_i. Every step tries its whole
/// length first, so that nothing but the state decides. Where rows change their pieces the order is
/// lost, the estimate tells, and the parts get shorter; where a contact begins at some speed the
/// force jumps, and a part of h/512 is taken whatever it estimates: the jump then lies within it.
///
/// What begins and ends between two stages no estimate tells, so that the parts are no longer than
/// what is in sight (tunnelling.hpp), from their start and, where speeds have grown, back from
/// their end: StepStats::tunnellingSplits. A step that is not divided, or a part of h/512, that is
/// longer than that is counted in StepStats::possibleTunnelling.

#include "softgauss/engine/step/contact_source.hpp"
#include "softgauss/engine/step/data.hpp"
#include "softgauss/engine/step/integrators/tableau.hpp"

namespace softgauss {

/// Moves the state on by options.timestep. `data` holds the stages at the state and its forward
/// solution, which is the first k; they stay. `input`: what is applied over the step. Returns
/// false, with the state untouched, where a stage is not finite.
bool rungeKutta(const Tableau& tableau, const Model& model, const Input& input,
                ContactSource* contacts, Data& data, State& state) noexcept;

}  // namespace softgauss

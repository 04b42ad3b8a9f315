// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Error control for the steps of one solve (Options::stepDoubling): each part of a step is taken
/// once at its length and twice at half of it, whole convex steps with their own solves and rows;
///
///   e = (q², v²) ⊖ (q¹, v¹),   |e_q| ≤ tolerance h_i/h,   h_i |e_v| ≤ tolerance h_i/h      (7.6)
///
/// q², v² of the two halves is what is kept. For a method of order 1 the error of the halves is as
/// large as e, for the leapfrog a third of it. A part that fails is shortened:
/// StepStats::rejections. Every step tries its whole length first, so that nothing but the state
/// decides. Parts of h/512 are taken whatever they estimate, and counted in
/// StepStats::minimumStepsAccepted: where force jumps, |e_v| does not fall with the length. No part
/// is longer than what is in sight (tunnelling.hpp). Three solves for a step that is not divided
/// [Kurtz, Castro 2025, of Drake's CENIC].

#include "softgauss/engine/step/contact_source.hpp"
#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// Moves the state on by options.timestep from `start`, which is `state` but for the leapfrog's,
/// that is at mid-step. `data` holds the stages at the state and its forward solution; they stay.
/// `input`: what is applied over the step. Returns false, with the state untouched, where the
/// result is not finite.
bool stepDoubling(const Model& model, const Input& input, ContactSource* contacts,
                  const State& start, Data& data, State& state) noexcept;

}  // namespace softgauss

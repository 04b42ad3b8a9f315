// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Joint damping and stiff springs at the end of the step: what the integrators of one solve have
/// in common (T.95).

#include "engine/step/data.hpp"

namespace softgauss {

/// A spring that swings by more than a radian in a step, taken at the step's end.
bool isStiffSpring(const Model& model, const Data& data, const Plan::Spring& spring);
bool anyStiffSpring(const Model& model, const Data& data);

/// data.forward.Md ← h D + h² K_s and net ← net − h K_s v.
void setImplicitForces(const Model& model, const State& state, Data& data, VectorX& net);

}  // namespace softgauss

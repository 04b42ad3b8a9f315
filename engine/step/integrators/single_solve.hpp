// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The integrators that move on with the one solve of the step's start.

#include "engine/step/integrators/implicit_velocity.hpp"
#include "engine/step/integrators/semi_implicit_euler.hpp"

namespace softgauss {

/// Reads data.forward, writes data.acceleration and the state. Returns false, with the state
/// untouched, when the result is not finite. Options::solvesOnce() tells of which integrators.
inline bool moveOnce(const Model& model, Data& data, State& state) {
  return model.options.integrator == Integrator::implicit ? implicitVelocity(model, data, state)
                                                          : semiImplicitEuler(model, data, state);
}

}  // namespace softgauss

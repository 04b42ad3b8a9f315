// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The integrators that move on with the one solve of the step's start.

#include "softgauss/engine/step/integrators/implicit_velocity.hpp"
#include "softgauss/engine/step/integrators/leapfrog.hpp"
#include "softgauss/engine/step/integrators/semi_implicit_euler.hpp"

namespace softgauss {

/// Reads data.forward, writes data.acceleration and the state, which the leapfrog takes at
/// mid-step. Returns false, with the state untouched, when the result is not finite.
/// Options::isSingleSolve() tells of which integrators.
inline bool moveOnce(const Model& model, Data& data, State& state) {
  switch (model.options.integrator) {
    case Integrator::implicit:
      return implicitVelocity(model, data, state);
    case Integrator::leapfrog:
      return kickAndDrift(model, data, state);
    default:
      return semiImplicitEuler(model, data, state);
  }
}

}  // namespace softgauss

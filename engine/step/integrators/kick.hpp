// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the integrators of one solve share between the solve and the new velocity.

#include "engine/step/data.hpp"

namespace softgauss {

/// Solves again where rows have to hold what swings too fast (T.128). False: not finite.
bool holdSwings(const Model& model, Data& data, const State& state);

/// Not finite, or turning so fast that the square of the angle overflows.
bool tooFast(const Model& model, const VectorX& v);

}  // namespace softgauss

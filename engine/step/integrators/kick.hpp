// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the integrators of one solve share between the solve and the new velocity.

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// Solves again where rows have to hold what swings too fast (6.9). False: not finite.
bool addGeometricStiffness(const Model& model, Data& data, const State& state);

/// Not finite, or turning so fast that the square of the angle overflows.
bool tooFast(const Model& model, const VectorX& v);

}  // namespace softgauss

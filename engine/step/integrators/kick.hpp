// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the integrators of one solve share between the solve and the new velocity.

#include <cstdint>
#include <span>

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// state.connectionForces ← those of the solve, of which the next one makes its rows (6.9); of
/// connections of these trees alone, unless `trees` is empty.
void keepConnectionForces(const Model& model, Data& data, State& state,
                          std::span<const std::uint8_t> trees = {});

/// Of these trees: not finite, or turning so fast that the square of the angle overflows.
bool tooFast(const Model& model, const TreeSelection& trees, const VectorX& v);

}  // namespace softgauss

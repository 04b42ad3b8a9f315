// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The ground plane of a scene, and what stands on it.

#include <string>
#include <vector>

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/engine/model/state.hpp"

namespace softgauss {

bool hasFloatingBase(const Model& model);

/// A horizontal plane of the world at a height [m].
void addGround(ModelBuilder& builder, double height, const Material& material);

/// Raises or lowers floating trees until their lowest points are at `ground` [m]: all, or those
/// whose root link is named.
void standOnGround(const Model& model, double ground, const std::vector<std::string>* links,
                   State& state);

}  // namespace softgauss

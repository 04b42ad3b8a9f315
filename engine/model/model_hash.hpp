// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whether two models move alike.

#include <cstdint>

#include "softgauss/engine/model/model.hpp"

namespace softgauss {

/// 64-bit hash of all that a step depends on, options included, and of the names; visuals, colours
/// and warnings are left out, and where meshes were read from.
std::uint64_t hash(const Model& model);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where joints that follow others start.

#include <set>

#include "engine/model/model.hpp"

namespace softgauss {

/// Puts every joint that follows another where its leader has it, along chains of followers too.
/// Those in `kept`, by the bodies that they carry, stay where they are.
void placeFollowers(const Model& model, const std::set<int>& kept, VectorX& q);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The order of joints that follow others, and where they start.

#include <set>
#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss {

/// Couplings, each after the one by which its leader follows.
std::vector<const JointCoupling*> leadersFirst(const Model& model);

/// Puts every joint that follows another where its leader has it, along chains of followers too.
/// Those in `kept`, by the bodies that they carry, stay where they are.
void placeFollowers(const Model& model, const std::set<int>& kept, VectorX& q);

}  // namespace softgauss

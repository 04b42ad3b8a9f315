// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The order of joints that follow others, and where they start.

#include <optional>
#include <set>
#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss {

/// Couplings, each after the one by which its leader follows.
std::vector<const JointCoupling*> leadersFirst(const Model& model);

/// Puts every joint that follows another where its leader has it, along chains of followers too.
/// Those in `kept`, by the bodies that they carry, stay where they are.
void placeFollowers(const Model& model, const std::set<int>& kept, VectorX& q);

/// Where the leader of the joint of `body` has it, at q; nothing where it has none.
std::optional<double> followedPosition(const Model& model, int body, const VectorX& q);

/// [rad or m] Positions that are given, and rounded, may differ so much from those that are
/// followed.
inline constexpr double kFollowerTolerance = 1e-3;

}  // namespace softgauss

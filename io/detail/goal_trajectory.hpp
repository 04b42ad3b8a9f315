// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The key `trajectory` of goals whose target moves: `circle`, knots, or a `file` of knots.

#include <vector>

#include "softgauss/engine/model/model.hpp"
#include "softgauss/gdd/goals/joints.hpp"
#include "softgauss/io/detail/yaml.hpp"

namespace softgauss::io::detail {

/// Of a trajectory or a minimum-jerk line [s]: less is below any time step, and accelerations go as
/// its square.
inline constexpr double kShortestPiece = 1e-6;

/// The target of a goal that is a place, from one of the keys `target` and `trajectory`; without
/// either it stays as it is, or fails where it is `required`.
void readPlaceTarget(const YamlMap& keys, bool required, gdd::PlaceTarget& target);

/// Joints whose target moves, from the key `trajectory`; none without it.
std::vector<gdd::JointTarget> readJointTrajectory(const YamlMap& keys, const Model& model);

}  // namespace softgauss::io::detail

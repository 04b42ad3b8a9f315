// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Joints that move nothing but, by couplings, others.
///
/// A hand's motor may turn a link without mass, and fingers elsewhere follow it. With its followers
/// the joint has an inertia, alone it has none, and M⁻¹ is of each joint alone. Such a joint gets
/// an armature of a hundredth of what its followers put on it, Σ p′² M_ff at zero, and a warning.

#include "softgauss/engine/model/model.hpp"

namespace softgauss::detail {

/// The share of their followers' inertia that such joints get.
inline constexpr double kLeaderShare = 0.01;

/// Bodies, subtrees and couplings are complete.
void addLeaderArmature(Model& model);

}  // namespace softgauss::detail

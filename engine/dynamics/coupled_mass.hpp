// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Mass matrices that are regular only because joints follow others.
///
/// A finger of three joints whose middle links have no mass: stretched, the tip moves with two of
/// them, and M of all three is singular. Where the third follows the second, GᵀM G of the joints
/// that are free is regular, and that is what the robot feels. The step takes M⁻¹ all the same, as
/// its couplings are soft.

#include "softgauss/engine/model/model.hpp"

namespace softgauss {

/// The share of M_ii that coupled joints get as armature where they need it.
inline constexpr double kCoupledShare = 0.01;

/// Where M is singular at q and GᵀM G is not: gives every coupled joint of the trees in question an
/// armature of kCoupledShare of its M_ii, and the model a warning. Else nothing is changed.
void regulariseCoupledJoints(Model& model, const VectorX& q);

}  // namespace softgauss

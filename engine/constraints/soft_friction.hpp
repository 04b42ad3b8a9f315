// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Dry friction as soft at rest as in motion, for goal directed dynamics.
///
/// A joint that sticks does not answer its control (T.94): around it goals see no slope, and a
/// greedy controller would leave it stuck. So while goals choose the controls friction keeps R₀ of
/// (T.27), with its creep.

#include "engine/constraints/dry_friction.hpp"

namespace softgauss {

/// Gives rows that are assembled the regulariser R₀, whatever the speed.
void softenFriction(const Model& model, const InverseWeights& weights, DryFriction& rows);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A task of planning as MuJoCo's own description, for a planner there.

#include <string>

#include "softgauss/engine/model/model.hpp"

namespace softgauss::app {

/// Of contacts and limits whose softness nobody gave.
enum class UngivenSoftness {
  /// The same springs and dampers at the end of a step as ours, (3.15); but MuJoCo's make no force
  /// before they touch, and know no law of slip.
  nearRigid,
  mujocoDefault
};

/// The model of a planner, on the contacts that it has, as compare_mujoco writes it, and besides a
/// motor of each actuated dof within its bounds and three user sensors, `position`, `velocity` and
/// `control`: residuals of the norm ½ rᵀr, each of this weight. MuJoCo integrates by its Euler
/// step. Throws ModelError where it has no counterpart.
std::string planMjcf(const Model& model, UngivenSoftness softness, double weight);

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What holds a goal back, each by its share, in names of the scene.

#include <string>
#include <vector>

#include "softgauss/gdd/goal_balance.hpp"
#include "softgauss/io/summary.hpp"

namespace softgauss::io {

struct HeldBack {
  std::vector<GoalOutcome::Cause> causes;  ///< the largest first; their shares add up to 1
  /// What the goal pulls with, over what it would at rest (gdd::Opposition::held); 1 where nobody
  /// knows.
  double held = 1.0;
  bool singular = false;  ///< gdd::Opposition::singular
  double weighed = 0.0;   ///< share of what the goal's own weight is set against
};

/// Of goal i of a balance that is solved; `dof` as of GoalBalance::against(). `limits` are those of
/// its controller.
HeldBack heldBack(const Model& model, const gdd::ControlLimits& limits, gdd::GoalBalance& balance,
                  int i, int dof = -1);

}  // namespace softgauss::io

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a robot cannot do from the start: hold itself against gravity.

#include <string>
#include <vector>

#include "softgauss/engine/step/data.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"

namespace softgauss::app {

/// Actuated joints, and actuators, that need more than their limits allow to hold the robot where
/// it is (8.6), by more than a hundredth: a warning, or none; none where no goal asks for it. The
/// stages of `data` are computed for `state`, and have to be again.
std::vector<std::string> weakAtStart(const Model& model, const State& state,
                                     const gdd::GoalDirectedController& controller, Data& data);

}  // namespace softgauss::app

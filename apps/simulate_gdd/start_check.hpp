// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is told of a start: a robot cannot hold itself against gravity, goals are in degrees.

#include <string>
#include <vector>

#include "softgauss/engine/step/data.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"

namespace softgauss::app {

/// Warnings, none where there are no goals:
/// actuated joints, and actuators, that need more than their limits allow to hold the robot where
/// it is (8.6), by more than a hundredth;
/// hinges that a posture sends beyond their range, to where degrees would be within it.
/// The stages of `data` are computed for `state`, and have to be again.
std::vector<std::string> startWarnings(const Model& model, const State& state,
                                       const gdd::GoalDirectedController& controller, Data& data);

}  // namespace softgauss::app

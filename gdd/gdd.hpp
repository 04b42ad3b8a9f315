// SPDX-License-Identifier: Apache-2.0
#pragma once

/// softgauss::gdd on one screen.
///
///   gdd::GoalDirectedController controller(model);
///   controller.goals.push_back(std::make_unique<gdd::Reach>(model, "right_hand", target));
///   controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
///   controller.step(model, Input{}, state, data, &contacts);

#include "gdd/goal_directed_islands.hpp"
#include "gdd/goal_directed_step.hpp"
#include "gdd/goals/balance.hpp"
#include "gdd/goals/center_of_pressure.hpp"
#include "gdd/goals/contact_force.hpp"
#include "gdd/goals/effort.hpp"
#include "gdd/goals/functions.hpp"
#include "gdd/goals/hold.hpp"
#include "gdd/goals/joints.hpp"
#include "gdd/goals/keep_clear.hpp"
#include "gdd/goals/link_acceleration.hpp"
#include "gdd/goals/look_at.hpp"
#include "gdd/goals/posture.hpp"
#include "gdd/goals/reach.hpp"
#include "gdd/goals/virtual_damping.hpp"

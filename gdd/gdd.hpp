// SPDX-License-Identifier: Apache-2.0
#pragma once

/// softgauss::gdd on one screen.
///
///   gdd::GoalDirectedController controller(model);
///   controller.goals.push_back(std::make_unique<gdd::Reach>(model, "right_hand", target));
///   controller.goals.push_back(std::make_unique<gdd::VirtualDamping>());
///   controller.step(model, Input{}, state, data, &contacts);

#include "softgauss/gdd/goal_directed_step.hpp"
#include "softgauss/gdd/goals/balance.hpp"
#include "softgauss/gdd/goals/center_of_pressure.hpp"
#include "softgauss/gdd/goals/contact_force.hpp"
#include "softgauss/gdd/goals/default_weight.hpp"
#include "softgauss/gdd/goals/effort.hpp"
#include "softgauss/gdd/goals/functions.hpp"
#include "softgauss/gdd/goals/hold.hpp"
#include "softgauss/gdd/goals/joint_velocity.hpp"
#include "softgauss/gdd/goals/joints.hpp"
#include "softgauss/gdd/goals/keep_clear.hpp"
#include "softgauss/gdd/goals/link_acceleration.hpp"
#include "softgauss/gdd/goals/look_at.hpp"
#include "softgauss/gdd/goals/posture.hpp"
#include "softgauss/gdd/goals/quadratic_value.hpp"
#include "softgauss/gdd/goals/reach.hpp"
#include "softgauss/gdd/goals/standing_balance.hpp"
#include "softgauss/gdd/goals/trajectory.hpp"
#include "softgauss/gdd/goals/virtual_damping.hpp"
#include "softgauss/gdd/motion_limits.hpp"

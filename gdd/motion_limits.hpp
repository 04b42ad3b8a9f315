// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Velocity limits and range ends that a controller respects.
///
/// With V_i the velocity limit of joint i and q_i its position in the range up to b_i, the joint
/// may move up at
///   u_i = min(V_i, max(v₀, √(2 â_i (b_i − q_i)))),   â_i = min(½ τ_i/M_ii, v₀/h)
/// as fast as it is allowed to, and no faster than its motor, of effort τ_i, can still brake with
/// half of what it has: the other half is for what it carries. It arrives at v₀ and not at speed,
/// for in a step it brakes by no more than v₀. A bound that is nearer than the motor needs would
/// hold the joint back where other goals must have it: a knee that is all but straight has to
/// straighten at once where the robot is pushed. What keeps v_i below u_i is an upper bound of the
/// acceleration, approached in the time T, or in the step where that is longer, in the cost:
///   ½ w M_ii max(0, a_i − u̇_i − (u_i − v_i)/T)²,   u̇_i = −â_i v_i/u_i ahead of an end
/// and the same downwards. The weight w outweighs goals, and a cost is never infeasible: where
/// torque limits or contacts ask for more, the joint is too fast. A joint that
/// its motor, or as much acceleration as in the last step, brings no further than u_i/2 has no
/// term, so that slow motions have the bits that they have without. Only joints with an actuator
/// are kept; such bounds of velocity and position on the acceleration are usual in task space
/// inverse dynamics (Del Prete, 2018).

#include "softgauss/gdd/goal.hpp"
#include "softgauss/gdd/problem.hpp"

namespace softgauss::gdd {

struct MotionLimits {
  double weight = 1e8;         ///< w [-], against 10³ of a posture and 10⁵ of a strong goal
  double brakingTime = 0.01;   ///< T [s]
  double arrivalSpeed = 0.05;  ///< v₀ [rad/s or m/s]

  /// Adds the terms of the joints that `limits` has an actuator for.
  void addCost(const GoalContext& context, const ControlLimits& limits, GoalCost& cost) const;
};

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Servos of joints, one row for each dof that has one, stable at any gain.
///
/// The force is that of the end of the step, whose spring is the law (3.14) of all rows:
///   f = −K (q + t v⁺ − u) − B (v⁺ − u̇) clamped to ± effort,   K = kp, B = kd
///     = −D x,   x = aᵢ − a_ref,   a_ref = −vᵢ/h − (K/D)(q − u) + (B/D) u̇,   D = h (t K + B) (4.15)
/// with u the set point of the step's end. A loop of the same gains that is closed once a step acts
/// on what was measured, and diverges where h kd or h² kp exceeds the inertia a few times; the row
/// does not. A spring too stiff for the step, h² K > 1 per inertia, is taken at t = h, lest it
/// rings as contacts would (3.8). Where goals control a tree they choose its forces, and its servos
/// have no rows: setPointOf() tells the set point that makes the same force. Contract: |f| ≤
/// effort.

#include <vector>

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/joint_rows.hpp"

namespace softgauss {

class ServoDrive : public JointRows<Huber> {
 public:
  void assemble(const Assembly& in);
};

/// The set point that makes `force` [N m or N] where a step has ended at q, v: what a drive is to
/// be told for the force that goals have chosen; of the row, where its t ends with the step. Needs
/// servo.kp > 0.
inline double setPointOf(const Servo& servo, double q, double v, double force) {
  return q + (force + servo.kd * (v - servo.setPointRate)) / servo.kp;
}

}  // namespace softgauss

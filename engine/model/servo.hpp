// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A position or velocity servo of a joint: a PD loop in its drive. Parameters only; its row is
/// made in constraints/servo_drive.hpp.

#include "softgauss/engine/core/check.hpp"

namespace softgauss {

/// f = kp (u − q) + kd (u̇ − q̇), no larger than `effort`, with u and u̇ the set point and its rate.
struct Servo {
  double kp = 0.0;            ///< [N m/rad or N/m]; 0: a velocity servo
  double kd = 0.0;            ///< [N m s/rad or N s/m]
  double effort = kInfinity;  ///< largest force [N m or N]
  double setPoint = 0.0;      ///< u where Input gives none [rad or m]
  double setPointRate = 0.0;  ///< u̇ where Input gives none [rad/s or m/s]

  bool exists() const { return kp > 0.0 || kd > 0.0; }
};

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Position and velocity servos of an MJCF: actuators of a joint whose force is affine in it.
///
/// With l = gear q, MuJoCo's  clip(g u + b₀ + b₁ l + b₂ l̇, ± F)  of a joint is
///   kp (s − q) + kd (ṡ − q̇)   clamped to ± |gear| F,   kp = −b₁ gear²,   kd = −b₂ gear²
/// with the set point s = (g u + b₀)/(−b₁ gear) or, where b₁ = 0, its rate ṡ = (g u + b₀)/(−b₂
/// gear). A dampratio is kd = 2 ratio √(kp M_ii), M of the model at q0.

#include <optional>

#include "softgauss/io/mjcf/actuator.hpp"

namespace softgauss::io::mjcf {

struct JointServo {
  std::string joint;
  double kp = 0.0, kd = 0.0, effort = kInfinity;
  double dampingRatio = 0.0;              ///< above 0: in place of kd
  double perCommand = 0.0, offset = 0.0;  ///< set point, or rate, by the command: offset + … · u
  double lower = -kInfinity, upper = kInfinity;  ///< of the command

  double setPoint(double command) const {
    return offset + perCommand * std::clamp(command, lower, upper);
  }
};

/// What an actuator of `joint` whose force is within ± `force` (without gear) is as a servo;
/// nothing where it is a motor, or one that pushes away from its set point, or of bounds that
/// differ.
std::optional<JointServo> servoOf(const Actuator& actuator, std::pair<double, double> force,
                                  bool autolimits);

/// Gives joints of the model their servos, told `commands` (one an actuator; empty: zeros).
void setServos(const std::vector<std::optional<JointServo>>& servos,
               const std::vector<double>& commands, Model& model);

}  // namespace softgauss::io::mjcf

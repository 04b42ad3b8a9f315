// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <actuator>: motors and servos.
///
/// MuJoCo's actuator makes the force  f = clip(gain · clip(ctrl) + b₀ + b₁ l + b₂ l̇)  on a length l
/// = gear · q of a joint, or of a fixed tendon. Goals choose forces, not set points: to them an
/// actuator is the forces that it can make, of a motor (no bias) gain · ctrlrange within
/// forcerange, of a servo (bias) forcerange alone. Without goals servos of joints follow their set
/// points (mjcf/servo.hpp).

#include <map>

#include "softgauss/io/actuators.hpp"
#include "softgauss/io/mjcf/xml.hpp"

namespace softgauss::io::mjcf {

struct Actuator {
  Element element;
  std::string name;
  Choice ctrlLimited = Choice::automatic, forceLimited = Choice::automatic;
  std::array<double, 2> ctrlRange{}, forceRange{};
  std::array<double, 6> gear{1, 0, 0, 0, 0, 0};
  enum class Gain { fixed, affine, other } gain = Gain::fixed;
  enum class Bias { none, affine, other } bias = Bias::none;
  std::array<double, 10> gainParameters{1}, biasParameters{};
  std::array<double, 3> damping{};
  double armature = 0.0;
  bool isDynamic = false;  ///< has an activation state
  double inheritRange = 0.0;
  std::string joint, tendon, otherTarget;

  void read(const Element& element);
  bool isServo() const { return bias == Bias::affine; }
  double kp() const { return -biasParameters[1]; }
  /// Throws where it cannot be expressed.
  void check() const;
  /// Bounds of its force, without gear.
  std::pair<double, double> forces(bool autolimits) const;
};

/// Whether an element of <actuator> is of a kind that is read.
bool isReadActuator(const std::string& tag);

}  // namespace softgauss::io::mjcf

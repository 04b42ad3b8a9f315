// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/servo.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/dynamics/inertia.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss::io::mjcf {

std::optional<JointServo> servoOf(const Actuator& actuator, std::pair<double, double> force,
                                  bool autolimits) {
  const double g = actuator.gainParameters[0], gear = actuator.gear[0];
  const double kp = actuator.kp(), b0 = actuator.biasParameters[0], b2 = actuator.biasParameters[2];
  // MuJoCo reads a positive damping of a position servo as its damping ratio.
  const bool isRatio = b2 > 0.0 && g == kp && kp > 0.0;
  const bool acts = kp >= 0.0 && (b2 <= 0.0 || isRatio) && (kp > 0.0 || b2 < 0.0);
  if (!actuator.isServo() || !acts || actuator.joint.empty() || force.first != -force.second)
    return std::nullopt;
  JointServo servo;
  servo.joint = actuator.joint;
  servo.kp = kp * gear * gear;
  (isRatio ? servo.dampingRatio : servo.kd) = isRatio ? b2 : -b2 * gear * gear;
  servo.effort = force.second * std::abs(gear);
  const double per = (kp > 0.0 ? kp : -b2) * gear;
  servo.perCommand = g / per;
  servo.offset = b0 / per;
  if (isLimited(actuator.element, "ctrllimited", actuator.ctrlLimited, actuator.ctrlRange,
                autolimits))
    std::tie(servo.lower, servo.upper) = std::pair(actuator.ctrlRange[0], actuator.ctrlRange[1]);
  return servo;
}

void setServos(const std::vector<std::optional<JointServo>>& servos,
               const std::vector<double>& commands, Model& model) {
  VectorX inertia(0);
  const auto inertiaOf = [&](int dof) {
    if (inertia.size() == 0) {
      Kinematics kinematics(model);
      MassMatrix mass(model);
      computeKinematics(model, State(model), kinematics);
      computeMassMatrix(model, kinematics, mass);
      inertia.resize(model.nv);
      for (int i = 0; i < model.nv; ++i) inertia[i] = mass.M.row(i)[i];
    }
    return inertia[dof];
  };
  for (std::size_t i = 0; i < servos.size(); ++i) {
    if (!servos[i]) continue;
    const JointServo& from = *servos[i];
    const int dof = model.bodies[idx(model.findJoint(from.joint))].v;
    Servo& to = model.dofs[idx(dof)].servo;
    to.kp = from.kp;
    to.kd = from.dampingRatio > 0.0 ? 2.0 * from.dampingRatio * std::sqrt(from.kp * inertiaOf(dof))
                                    : from.kd;
    to.effort = from.effort;
    (from.kp > 0.0 ? to.setPoint : to.setPointRate) =
        from.setPoint(i < commands.size() ? commands[i] : 0.0);
  }
}

}  // namespace softgauss::io::mjcf

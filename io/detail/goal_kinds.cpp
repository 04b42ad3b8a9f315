// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/goal_kinds.hpp"

namespace softgauss::io::detail {

const std::vector<GoalKind>& goalKinds() {
  static const std::vector<GoalKind> kinds = {
      {"reach",
       {"link", "target", "trajectory", "point", "rpy", "quaternion", "weight", "rotation_weight",
        "metric", "stiffness", "damping", "minimum_jerk"},
       readReach},
      {"link_acceleration",
       {"link", "linear", "angular", "point", "weight", "rotation_weight", "metric"},
       readLinkAcceleration},
      {"look_at",
       {"link", "target", "trajectory", "axis", "point", "weight", "stiffness", "damping"},
       readLookAt},
      {"hold", {"link", "point", "weight", "rotation_weight", "rate"}, readHold},
      {"keep_clear", {"link", "from", "distance", "weight", "stiffness", "damping"}, readKeepClear},
      {"posture", {"weight", "stiffness", "damping", "joints", "trajectory"}, readPosture},
      {"joint_posture",
       {"joints", "trajectory", "weight", "stiffness", "damping"},
       readJointPosture},
      {"joint_velocity", {"joints", "weight", "rate"}, readJointVelocity},
      {"acceleration", {"joints", "weight"}, readAcceleration},
      {"damping", {"weight", "rate", "metric"}, readDamping},
      {"effort", {"joints", "weight"}, readEffort},
      {"center_of_mass",
       {"link", "target", "trajectory", "axes", "weight", "stiffness", "damping"},
       readCenterOfMass},
      {"momentum",
       {"link", "linear", "angular", "linear_weight", "angular_weight", "rate"},
       readMomentum},
      {"capture_point", {"link", "target", "trajectory", "weight", "rate"}, readCapturePoint},
      {"contact_force", {"link", "force", "axes", "by", "weight"}, readContactForce},
      {"center_of_pressure", {"target", "link", "links", "weight"}, readCenterOfPressure},
  };
  return kinds;
}

}  // namespace softgauss::io::detail

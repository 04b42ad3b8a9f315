// SPDX-License-Identifier: Apache-2.0
#include "io/detail/goal_kinds.hpp"

namespace softgauss::io::detail {

const std::vector<GoalKind>& goalKinds() {
  static const std::vector<GoalKind> kinds = {
      {"reach",
       {"link", "target", "point", "weight", "stiffness", "damping", "minimum_jerk"},
       readReach},
      {"posture", {"weight", "stiffness", "damping", "joints"}, readPosture},
      {"joint_posture", {"joints", "weight", "stiffness", "damping"}, readJointPosture},
      {"acceleration", {"joints", "weight"}, readAcceleration},
      {"damping", {"weight", "rate"}, readDamping},
  };
  return kinds;
}

}  // namespace softgauss::io::detail

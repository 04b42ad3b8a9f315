// SPDX-License-Identifier: Apache-2.0
#pragma once

/// External wrenches that act for some time, as scene files list them (docs/reference/scenes.md).
///
/// A force f and a moment m, both in world axes, act at a point P that moves with its link. About
/// the origin of the body B that this is
///   F_Bo = (m + R_WB p_BP × f, f)
/// A wrench acts in the steps whose middle lies between its start and its end, so that its impulse
/// is that of the interval rounded to whole steps, whatever the rounding of time.

#include <limits>
#include <string>
#include <vector>

#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss::io {

struct TimedWrench {
  std::string link;
  Vector3 p_LP = Vector3::Zero();                        ///< point, in the link [m]
  Vector3 force_W = Vector3::Zero();                     ///< world [N]
  Vector3 moment_W = Vector3::Zero();                    ///< about P, world [N m]
  double start = 0.0;                                    ///< [s]
  double end = std::numeric_limits<double>::infinity();  ///< [s]
  SourceLocation where;
};

class WrenchSchedule {
 public:
  WrenchSchedule() = default;
  /// Throws ModelError where a link does not exist or cannot move.
  WrenchSchedule(const Model& model, const std::vector<TimedWrench>& wrenches);

  bool empty() const { return wrenches_.empty(); }
  /// The first time after `time` at which one begins or ends [s], ∞ without.
  double nextChange(double time) const;
  /// Those that act in the step from `time`; `kinematics` is that of its start.
  void at(double time, double timestep, const Kinematics& kinematics,
          std::vector<ExternalWrench>& out) const;

 private:
  std::vector<TimedWrench> wrenches_;
  std::vector<int> bodies_;
  std::vector<Vector3> p_BP_;
};

}  // namespace softgauss::io

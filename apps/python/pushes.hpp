// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Forces from outside that act on links for as long as they are kept.

#include <string>
#include <vector>

#include "softgauss/io/simulation/simulation.hpp"

namespace softgauss::python {

class Pushes {
 public:
  /// Force [N] and moment [N m], world axes, at a point of the link [m], in place of what has acted
  /// on that link; zero: nothing acts on it. Throws NameError.
  void set(const Simulation& sim, const std::string& link, const Vector3& force_W,
           const Vector3& moment_W = Vector3::Zero(), const Vector3& p_LP = Vector3::Zero());
  bool empty() const { return pushes_.empty(); }
  /// Writes the wrenches of the step that is next into sim.input().
  void act(Simulation& sim);

 private:
  std::vector<io::TimedWrench> pushes_;
  io::WrenchSchedule schedule_;  ///< of those
  Kinematics kinematics_;
};

}  // namespace softgauss::python

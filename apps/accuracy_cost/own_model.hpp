// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A user's model as a problem: passive, from where simulate_gdd starts it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/accuracy_cost/problem.hpp"

namespace softgauss::app {

struct OwnModel {
  std::filesystem::path file;  ///< a URDF, or a scene where it ends in .yaml or .yml
  BaseKind base = BaseKind::automatic;
  /// Height of the ground [m], or "none"; empty: 0 where something floats. Of a URDF, as `base`.
  std::string ground;
  std::vector<std::filesystem::path> packagePaths;  ///< io::UrdfOptions::packagePaths

  bool isScene() const;
};

struct OwnProblem {
  Problem problem;                 ///< called as the file is, with its ending
  std::vector<std::string> notes;  ///< what a user should know: what is left out, and why
};

/// It is compared in windows where any two shapes may touch, else as a whole. Goals, controls and
/// wrenches are left out; so is MuJoCo where it does not have all that is in the model. Throws
/// ModelError.
OwnProblem ownProblem(const OwnModel& own);

}  // namespace softgauss::app

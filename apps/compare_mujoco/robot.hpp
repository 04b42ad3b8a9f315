// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A robot of a URDF as both engines get it, where it starts, and controls that swing it.

#include <filesystem>
#include <string>
#include <vector>

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/engine/model/state.hpp"

namespace softgauss::app {

/// A URDF and how it is read.
struct RobotFile {
  std::string file;
  std::string base = "automatic";  ///< or fixed, floating
  double timestep = 0.002;         ///< [s]
  std::vector<std::filesystem::path> packagePaths;
};

/// What floats gets a ground. Throws ModelError.
Model loadRobot(const RobotFile& robot, bool likeMujoco);

/// At rest; floating bases stand on the ground.
State standingState(const Model& model);

/// Controls that swing at a time, each joint at its own pace, by a twentieth of its limit (nv).
VectorX swingingControl(const Model& model, double time);

}  // namespace softgauss::app

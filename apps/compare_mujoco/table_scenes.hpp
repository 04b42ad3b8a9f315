// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The scenes of the table of speeds.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/compare_mujoco/robot.hpp"
#include "apps/step_benchmark/scenes.hpp"

namespace softgauss::app {

/// What drives a scene along the path whose steps are timed.
enum class Drive {
  none,
  torques,  ///< that vary with time, the same for both engines
  posture,  ///< torques by which goal directed dynamics has held a posture; both engines replay
            ///< them
  reach     ///< the same of a reach, and the controlled step itself is timed too
};

struct TableScene {
  std::string name;
  std::function<std::unique_ptr<Scene>()> make;  ///< at its start, with its controller
  Drive drive = Drive::none;
  int warmUp = 100;          ///< steps before the first window
  int windows = 4;           ///< pieces of the path that are timed
  int steps = 20;            ///< timed ones of a window
  int between = 20;          ///< steps from a window to the next
  bool inverse = false;      ///< inverse dynamics are timed too
  bool derivatives = false;  ///< and derivatives of a step
  std::string curve{};       ///< of growth that it belongs to; empty: of none
  int size = 0;              ///< along it: links or bodies
  bool large = false;        ///< left out where a quick table is asked for
};

/// Robots of the folder `robots`, chains, piles, boxes, and last the `extra` robots, held and
/// swung. Throws ModelError where one of these cannot be read.
std::vector<TableScene> tableScenes(const std::string& robots, const std::vector<RobotFile>& extra);

/// The names of the curves.
inline constexpr const char* kLying = "chain on the ground";
inline constexpr const char* kSwinging = "chain swinging";
inline constexpr const char* kPile = "pile";
inline constexpr const char* kBoxes = "boxes at rest";
inline constexpr const char* kHumanoids = "humanoids";

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What Simulation and its goals share.

#include "softgauss/io/contact_links.hpp"
#include "softgauss/io/simulation/run_recording.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "softgauss/io/simulation/time_grid.hpp"

namespace softgauss {

struct SimulationParts {
  SimulationParts(std::unique_ptr<Scene> loaded, const SimulationOptions& loadedWith);

  /// From scene->initial, with the goals of the scene alone; `otherModel`: scene->model has
  /// changed.
  void restart(bool otherModel);

  /// For the step from the present state.
  const Input& inputOfStep();

  std::unique_ptr<Scene> scene;
  SimulationOptions options;
  State state;
  std::unique_ptr<Data> data;
  std::unique_ptr<gdd::GoalDirectedController> controller;
  bool hasRegularisers = false, hasBalance = false;
  std::size_t regularisers = 0;  ///< the last of the goals
  Input input;
  Input applied;  ///< with the wrenches of the scene
  Input held;     ///< of solve()
  ControlSolution solution;
  State before;  ///< of solve()
  Kinematics kinematics;
  io::ContactLinks links;
  TimeGrid grid;
  std::unique_ptr<RunRecording> recording;  ///< of the run, where one was asked for
};

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From the command line to a model, its contacts, its initial state and its goals.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/simulate_gdd/options.hpp"
#include "collision/scene_contacts.hpp"
#include "gdd/gdd.hpp"
#include "io/actuators.hpp"
#include "io/urdf.hpp"
#include "io/wrenches.hpp"

namespace softgauss::app {

struct Scene {
  Model model;
  io::UrdfContents contents;
  std::unique_ptr<collision::SceneContacts> contacts;
  State initial;
  /// Surfaces by name.
  std::vector<std::pair<std::string, Material>> materials = {{"default", Material{}}};
  std::vector<io::TimedWrench> wrenches;
  io::WrenchSchedule schedule;  ///< of those
  std::vector<io::SceneActuator> actuators;
  bool hasGoals = false;  ///< the scene file holds goals
  gdd::GddSolver gddSolver = gdd::GddSolver::activeSet;
};

/// Throws ModelError.
std::unique_ptr<Scene> loadScene(const SimulateOptions& options);

/// The goals of the scene file, of --goals and of --reach, the latter with virtual damping (26).
/// Throws ModelError.
std::vector<std::unique_ptr<gdd::Goal>> makeGoals(const SimulateOptions& options,
                                                  const Scene& scene);

/// The text of --explain.
std::string explainScene(const Scene& scene);

}  // namespace softgauss::app

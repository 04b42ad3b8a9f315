// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From the command line to a model, its contacts, its initial state and its goals.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/simulate_gdd/base_notes.hpp"
#include "apps/simulate_gdd/options.hpp"
#include "collision/fcl_contacts.hpp"
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
  std::unique_ptr<collision::FclContacts> throughFcl;  ///< in their place, where it was asked for
  ContactSource& source() {
    return throughFcl ? static_cast<ContactSource&>(*throughFcl) : *contacts;
  }
  State initial;
  /// Surfaces by name.
  std::vector<std::pair<std::string, Material>> materials = {{"default", Material{}}};
  std::vector<io::TimedWrench> wrenches;
  io::WrenchSchedule schedule;  ///< of those
  std::vector<io::SceneActuator> actuators;
  BaseOrigin baseOrigin = BaseOrigin::convention;
  BaseNotes bases;
  bool hasGoals = false;  ///< the scene file holds goals
  bool fileSaysFcl = false;
  gdd::GddSolver gddSolver = gdd::GddSolver::activeSet;
};

/// Throws ModelError.
std::unique_ptr<Scene> loadScene(const SimulateOptions& options);

/// What the scene and the options ask of the control: its solver, what the actuators can do, and
/// the goals of the scene file, of --goals and of the command line, the latter with a weak posture
/// and virtual damping (26); no goals where the motion is passive or driven by torques. Throws
/// ModelError.
void setUp(const SimulateOptions& options, const Scene& scene,
           gdd::GoalDirectedController& controller);

/// The text of --explain.
std::string explainScene(const Scene& scene);

}  // namespace softgauss::app

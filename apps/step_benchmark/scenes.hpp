// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What is timed.

#include <memory>
#include <stdexcept>
#include <string>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/replay/recording.hpp"

namespace softgauss::app {

/// A model with all that steps it.
struct Scene {
  Model model;
  std::unique_ptr<collision::SceneContacts> contacts;
  State state;
  std::unique_ptr<Data> data;
  std::unique_ptr<gdd::GoalDirectedController> controller;  ///< null: passive
  std::unique_ptr<io::Recording> recording;                 ///< of --view; null: none

  void step() {
    const SolveStatus status = controller
                                   ? controller->step(model, {}, state, *data, contacts.get())
                                   : softgauss::step(model, {}, state, *data, contacts.get());
    if (isRefused(status)) throw std::runtime_error("the scene became non-finite");
  }
};

/// The plane z = 0.
void addGround(ModelBuilder& builder);

/// At rest; with `ground`, a floating root stands on the plane z = 0.
std::unique_ptr<Scene> makeScene(ModelBuilder builder, bool ground);

std::unique_ptr<Scene> makeScene(Model model);

/// folder/name.urdf.
std::unique_ptr<Scene> makeRobot(const std::string& folder, const std::string& name, bool ground);

/// A chain of n links of 0.1 m and 0.1 kg on hinges of alternating axes, hanging sideways.
ModelBuilder chain(int links);
std::unique_ptr<Scene> makeChain(int links);

/// Cubes of 0.2 m and 1 kg, free, `spacing` apart in rows of five, their centres at `height` [m];
/// the first of them at `from`.
ModelBuilder freeBoxes(int count, double height, double spacing = 0.3,
                       const Vector3& from = Vector3::Zero());

/// A goal for a point of `link`, and virtual damping.
void addReach(Scene& scene, const std::string& link, const Vector3& target);

}  // namespace softgauss::app

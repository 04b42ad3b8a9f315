// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From a URDF, MJCF or scene file to a model, its contacts, its initial state and its control.

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "softgauss/collision/fcl_contacts.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/gdd/gdd.hpp"
#include "softgauss/io/actuators.hpp"
#include "softgauss/io/goals.hpp"
#include "softgauss/io/scene.hpp"
#include "softgauss/io/simulation/base_notes.hpp"
#include "softgauss/io/simulation/options.hpp"
#include "softgauss/io/srdf.hpp"
#include "softgauss/io/wrenches.hpp"

namespace softgauss {

/// What a scene is made of, but for its contacts.
struct SceneParts {
  std::filesystem::path file;
  Model model;
  io::UrdfContents contents;
  std::vector<io::RobotSrdf> srdfs;
  std::vector<std::string> notes;  ///< what is reported before the first step, beside warnings
  State initial;
  std::optional<double> ground;  ///< height of the ground plane [m]
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
  // Lines of what only the whole program can judge; 0 where the file does not say it.
  SourceLocation timestepWhere, collisionWhere;
};

/// All that a run starts from. Stays where it is: contacts refer to the model.
struct Scene : SceneParts {
  std::unique_ptr<collision::SceneContacts> contacts;
  std::unique_ptr<collision::FclContacts> throughFcl;  ///< in their place, where it was asked for
  ContactSource& source() {
    return throughFcl ? static_cast<ContactSource&>(*throughFcl) : *contacts;
  }
};

/// Whether a file is a scene, by its name; standard input ("-") is looked at. Throws ModelError.
bool isSceneFile(const std::filesystem::path& file);

/// Throws ModelError where the file is at fault, OptionError where an option is.
std::unique_ptr<Scene> loadScene(const std::filesystem::path& file,
                                 const SimulationOptions& options = {});

/// The same scene, which shares nothing with the first but meshes: for another thread. Throws
/// ModelError.
std::unique_ptr<Scene> copyOf(const Scene& scene);

/// Places scalar joints [rad or m] by name, and what follows them. Throws OptionError "q0 NAME: …"
/// on an unknown joint, one given twice, or a position outside its range or not where its leader
/// has it.
void setJointPositions(const Model& model, const std::vector<std::pair<std::string, double>>& q0,
                       State& state);

/// What the file and the options ask of the control: its solver, what the actuators can do and the
/// goals of the scene file, unless they are left out. Throws ModelError.
void setUpControl(const Scene& scene, const SimulationOptions& options,
                  gdd::GoalDirectedController& controller);

/// The goals of a file. They refer to the scene's model. Throws ModelError.
io::GoalFile readGoalFile(const std::filesystem::path& file, const Scene& scene);

/// The same from the text of such a file; messages call it `name`.
io::GoalFile parseGoals(const std::string& text, const std::string& name, const Scene& scene);

/// The goals of a file, beside those that the controller has. Throws ModelError.
void addGoals(const std::filesystem::path& file, const Scene& scene,
              gdd::GoalDirectedController& controller);

/// What goals that are given one by one come with: a posture about `q`, of weight 1000 where none
/// [-] is given, which holds what they leave free, and virtual damping (26).
std::vector<std::unique_ptr<gdd::Goal>> regularisers(const VectorX& q,
                                                     std::optional<double> postureWeight);

/// What keeps the robots of a scene standing that stand at its start, beside goals that are given
/// one by one: nothing with `noBalance`.
std::vector<std::unique_ptr<gdd::Goal>> balanceOf(const Scene& scene,
                                                  const SimulationOptions& options);

/// Why the last step was refused: what does not fit the model, or what became non-finite, when, and
/// what touches deepest.
std::string failureText(const Model& model, const State& state, const Data& data);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A run of a Simulation as it is looked at: recorded step by step, and written as a replay page.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "softgauss/io/replay/recording.hpp"
#include "softgauss/io/simulation/scene.hpp"

namespace softgauss {

struct SimulationParts;

/// A mesh collides as its convex hull, so that is what is shown: by geometry, null where the shape
/// itself collides.
std::vector<std::shared_ptr<const Mesh>> collidingHulls(const Scene& scene);

/// Images that cover visual meshes of the model, of files of at most `largest` [MB]. `warnings`:
/// those that cannot be shown, and why.
std::map<const Mesh*, io::MeshImages> visualImages(const Model& model, double largest,
                                                   std::vector<std::string>& warnings);

/// What the stages of a step and its controller say of it, which took `stepUs` [µs]. `record` has
/// time, q and v of the step's start already.
void recordSolve(const Data& data, const gdd::GoalDirectedController& controller, double stepUs,
                 io::StepRecord& record);

class RunRecording {
 public:
  /// Begins with the present state. Goals are shown that are there now. The parts outlive it.
  explicit RunRecording(SimulationParts& parts);

  /// To be called around a step; what was recorded of a later time is forgotten.
  void beforeStep();
  void afterStep(double stepUs);
  /// The goals go: what they sought is shown no more.
  void forgetGoals() { recording_.forgetGoals(); }
  void forgetGoal(const gdd::Goal& goal) { recording_.forgetGoal(goal); }
  /// What was recorded until now. Throws ModelError where the file cannot be made, and
  /// std::runtime_error where it cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  static io::Recording begin(SimulationParts& parts);

  SimulationParts& parts_;
  io::Recording recording_;
  io::StepRecord record_;
  Kinematics kinematics_;  ///< at the step's start
};

}  // namespace softgauss

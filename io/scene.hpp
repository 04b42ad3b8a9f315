// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Reads scene files: robots and objects, where they stand, what they are made of, how they start.
/// The schema, with examples, is docs/reference/scenes.md.
///
/// Strict, as goals are: an unknown key, a value of another type than expected, a number out of
/// range, a file or name that does not exist end in a ModelError `file:line: robot 2 'left': key
/// 'urdf': found …, expected …`.

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "softgauss/engine/model/state.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"
#include "softgauss/io/actuators.hpp"
#include "softgauss/io/srdf.hpp"
#include "softgauss/io/urdf.hpp"
#include "softgauss/io/wrenches.hpp"

namespace softgauss::io {

/// Which keys of the integration a file gives; the rest are defaults.
struct IntegrationKeys {
  bool integrator = false;
  bool tolerance = false;  ///< integration_tolerance
};

/// Whether Options::integrationTolerance changes anything.
inline bool controlsError(const Options& options) {
  return options.integrator == Integrator::dormandPrince ||
         (options.stepDoubling && options.isSingleSolve());
}

/// A scene as its file describes it.
struct SceneFile {
  ModelBuilder builder;   ///< its options may still be changed before build()
  UrdfContents contents;  ///< of all robots and objects together

  /// The height of the ground plane [m], where the file gives one; with `noGround` it wants none.
  /// Where it says nothing, there is ground at 0 if anything floats.
  std::optional<double> ground;
  bool noGround = false;
  Material groundMaterial;
  std::vector<std::pair<std::string, Material>> materials;  ///< by name, "default" among them

  /// A floating root and how it starts.
  struct Start {
    std::string link;
    Vector3 velocity = Vector3::Zero();         ///< of its origin, world [m/s]
    Vector3 angularVelocity = Vector3::Zero();  ///< world [rad/s]
    bool onGround = false;  ///< raised or lowered until its lowest point touches the ground
  };
  std::vector<Start> starts;
  struct JointValue {
    std::string joint;
    double value = 0.0;
    SourceLocation where;
    std::string element;  ///< that says so, "robot 1: key 'joints.elbow'"
  };
  /// Of scalar joints [rad or m]; what follows another and is not here is where its leader has it.
  std::vector<JointValue> positions;
  std::vector<JointValue> velocities;  ///< of scalar joints [rad/s or m/s]
  std::vector<RobotSrdf> srdfs;    ///< states in which robots start are placed before `positions`
  std::vector<std::string> notes;  ///< on SRDFs that no key names

  IntegrationKeys integration;
  std::vector<TimedWrench> wrenches;
  std::vector<SceneActuator> actuators;  ///< controlLimits() makes them a control limits

  // Lines of what only the whole program can judge; 0 where the file does not say it.
  SourceLocation timestepWhere, collisionWhere;

  bool throughFcl = false;                  ///< contacts are to come through FCL
  bool hasGoals = false;                    ///< has a list that readGoals() reads
  std::optional<gdd::GddSolver> gddSolver;  ///< that follows them, where the file names one

  /// The state in which it starts, but for the heights of what stands on the ground. `model` was
  /// built by `builder`. Throws ModelError where a position lies outside its joint's range, or is
  /// that of a joint which follows another elsewhere. What does not fit of a state of an SRDF is
  /// reported in `warnings`.
  State initialState(const Model& model, std::vector<std::string>* warnings = nullptr) const;
};

/// Of the options, `base` and the materials are not read: the file says. Throws ModelError.
SceneFile readScene(const std::filesystem::path& file, const UrdfOptions& options = {});

}  // namespace softgauss::io

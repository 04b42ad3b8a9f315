// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a caller says about a URDF or scene that is loaded, over what the file says. The options of
/// simulate_gdd of the same names have the same meaning.

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"
#include "softgauss/io/urdf.hpp"

namespace softgauss {

struct SimulationOptions {
  BaseKind base = BaseKind::automatic;  ///< of a URDF
  bool guessBase = false;               ///< of a URDF: fixed where it would stand on its root alone
  std::optional<double> baseHeight;     ///< [m]; absent: the lowest point touches the ground
  std::optional<double> ground;         ///< height of the ground plane of a URDF [m]
  bool groundIsDefault = true;          ///< 0 for a floating base, none for a fixed one
  std::optional<double> timestep;       ///< absent: the file's own, or 0.002 [s]
  std::vector<std::pair<std::string, double>> q0;  ///< joints and where they start [rad or m]
  /// Of a URDF, that holds states and links which never collide; empty: the one of its package,
  /// `none`: none.
  std::filesystem::path srdf;
  std::string state;                       ///< of the SRDF, in which it starts; q0 comes on top
  std::optional<MechanismSet> mechanisms;  ///< absent: the file's own, or all
  std::optional<EffectSet> effects;        ///< absent: the file's own, or all
  bool zeroEffortIsUnlimited = false;
  bool ignoreVelocityLimits = false;  ///< goals alone decide how fast joints move
  bool inferInertia = false;          ///< of links of a URDF without, from their shapes
  int mostDofs = 2000;                ///< more take minutes to load and gigabytes to hold
  std::optional<io::MeshUse> meshes;  ///< absent: automatic, or hull as MuJoCo has it
  std::optional<Sleep> sleep;         ///< absent: the file's own, or none
  bool exactDiagonal = false;
  std::optional<Cone> cone;                     ///< absent: the file's own, or pyramidal
  std::optional<gdd::GddSolver> gddSolver;      ///< absent: the file's own, or the active set
  std::optional<gdd::ControlCost> controlCost;  ///< absent: the files' own, or about gravity
  std::optional<int> iterationBudget;           ///< of a control; absent: the solver's own
  std::optional<double> timeBudget;             ///< of a control [s]; absent: none
  std::optional<Integrator> integrator;         ///< absent: the file's own, or the leapfrog
  std::optional<double> integrationTolerance;
  bool stepDoubling = false;
  std::optional<bool> throughFcl;  ///< absent: as the file says, or own
  std::optional<bool> likeMujoco;  ///< --compatibility
  std::vector<std::filesystem::path> packagePaths;
  double largestMesh = 64.0;   ///< [MB]
  bool visualMeshes = false;   ///< read the meshes of visuals too
  bool noBalance = false;      ///< robots that stand are not kept standing beside a reach
  bool withoutGoals = false;   ///< the goals of the file are left out
  bool withoutServos = false;  ///< the servos of the file are left out: joints are driven by forces
};

/// An option that does not fit what is loaded. what() reads `<option> …`, the option in the words
/// of simulate_gdd without the dashes: "q0 elbow: is given twice".
class OptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace softgauss

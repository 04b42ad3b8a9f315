// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A log of data/reference: a scene, and what MuJoCo computed for it.

#include <string>
#include <vector>

#include "softgauss/engine/model/state.hpp"

namespace softgauss::test {

/// A contact as MuJoCo lists it; the normal points from the first geometry to the second.
struct ReferenceContact {
  std::string geometries[2];
  Vector3 position, normal, tangent;
  double distance = 0.0;
};

/// A constraint row.
struct Row {
  VectorX J;
  double D = 0.0;
  double reference = 0.0;  ///< a_ref
  double force = 0.0;
  bool eitherWay = false;  ///< −J, −a_ref and −f are the same row: friction of an elliptic cone
};

/// Sums over all moving bodies.
struct Totals {
  double mass = 0.0;       ///< [kg]
  double potential = 0.0;  ///< [J], as is kinetic
  double kinetic = 0.0;
  Vector3 centreOfMass, momentum, angularMomentum;  ///< the last one about the centre of mass
};

/// One state, and what follows from it.
struct ReferenceState {
  VectorX q, v, force;
  std::vector<ExternalWrench> wrenches;
  Totals totals;
  MatrixX M;
  VectorX bias, smoothAcceleration, acceleration;
  std::vector<ReferenceContact> contacts;
  std::vector<Row> rows;
  VectorX inverseAcceleration, inverseForce;  ///< inverse dynamics at another acceleration
};

/// Samples of a free run.
struct ReferenceTrajectory {
  std::string integrator;
  double timestep = 0.0;
  double every = 0.0;  ///< [s] between samples
  std::vector<VectorX> q, v;
};

struct ReferenceLog {
  std::string name;
  Model model;
  VectorX force;  ///< applied during the trajectories
  std::vector<ReferenceState> states;
  std::vector<ReferenceTrajectory> trajectories;

  /// The run of that integrator with the model's step, or with half of it.
  const ReferenceTrajectory& trajectory(const std::string& integrator, bool halfStep) const;
};

/// Names of the logs of scenes, sorted.
std::vector<std::string> referenceLogNames();
/// Those of the states of data/gdd_states, sorted; all begin with gdd_.
std::vector<std::string> gddLogNames();

/// Throws std::runtime_error, ModelError or a JSON error. The logs are read once.
const ReferenceLog& referenceLog(const std::string& name);

}  // namespace softgauss::test

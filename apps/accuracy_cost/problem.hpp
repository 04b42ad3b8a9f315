// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What accuracy is measured on: models without chance in them, and how they move.
///
/// All times are multiples of kPeriod, so that every step size below divides them. Open-loop forces
/// change at these times only: they are part of the model, and the same for every step size.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"

namespace softgauss::app {

/// States are compared this often, and forces change this often [s].
inline constexpr double kPeriod = 0.032;

/// Step sizes: kPeriod over 1, 2, 4 … 256 [s].
inline constexpr int kFewestSteps = 1, kMostSteps = 256;
/// With contact: at most half the time constant of contacts, beyond which the step size would
/// change the model (3.2).
inline constexpr int kFewestContactSteps = 4;

struct Problem {
  std::string name;   ///< as on the command line
  std::string title;  ///< one line
  /// Smooth: the whole motion is compared. With contact motions part by nature; then short windows
  /// of it are, each from a state of the reference.
  bool contact = false;
  bool passive = true;    ///< nothing adds energy
  bool lossless = false;  ///< and nothing takes it
  bool chaotic = false;   ///< small differences grow e-fold within the motion (--divergence)
  bool inMujoco = true;   ///< false: something in it has no counterpart there
  /// What sticks is as soft as what slides, as it is in MuJoCo; false: as simulate_gdd has it.
  bool softFriction = true;
  int periods = 62;  ///< of the whole motion (2 s)
  int windows = 1;
  int windowPeriods = 62;
  /// With contact: of the error control of our reference; the one that checks it has 100 times
  /// more. Where forces jump thousands of times in a second a tighter one finds no more.
  double referenceTolerance = 1e-12;
  std::function<ModelBuilder()> build;
  std::function<void(const Model&, State&)> start;            ///< null: at rest in q0
  std::function<void(const Model&, double, VectorX&)> force;  ///< τ from a time on; null: none
  /// The exact state at a time, where it is known in closed form.
  std::function<void(const Model&, double, State&)> exact;
};

/// All of them. `robots`: the folder of arm.urdf, hand.urdf, humanoid.urdf.
std::vector<Problem> allProblems(const std::string& robots);
std::vector<Problem> smoothProblems(const std::string& robots);
std::vector<Problem> contactProblems(const std::string& robots);

/// With contact: compared in ten windows of three periods.
Problem inWindows(Problem problem);
/// The whole motion of a problem, of so many seconds; its name says so.
Problem lasting(Problem problem, double seconds);

/// A link of a homogeneous box, of its half edges [m].
LinkSpec boxLink(const std::string& name, double mass, const Vector3& half,
                 const Vector3& com = Vector3::Zero());
JointSpec joint(const std::string& name, JointType type, const std::string& parent,
                const std::string& child, const Vector3& axis, const Vector3& place);

}  // namespace softgauss::app

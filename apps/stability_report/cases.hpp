// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The hard cases of data/scenes/stability, and what is measured on each.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"

namespace softgauss::app {

inline constexpr double kSteps[] = {0.002, 0.01};  ///< [s]

/// A case that is loaded, and one state of it, of whichever engine. All figures are computed here,
/// from q and v alone, so that both engines are measured alike.
struct Stage {
  explicit Stage(Model m);

  Model model;
  collision::SceneContacts contacts;
  Kinematics kinematics;
  ContactSet touching;
  State state;

  double energy();   ///< [J]
  double kinetic();  ///< [J]
  double overlap();  ///< deepest of any two shapes [m]
  Vector3 origin(const std::string& link);
  double tilt(const std::string& link);  ///< of its z axis from the vertical [rad]
};

/// One figure of a case.
struct Figure {
  std::string name, unit;
  double scale = 1.0;  ///< from SI units into `unit`
  double bound = 0.0;  ///< chosen before the run [unit]
  enum Of { worst, last } of = worst;
  /// From a state; `start` is what it was in the first state.
  std::function<double(Stage&, double start)> value;
  std::function<double(Stage&)> start = {};
};

struct HardCase {
  std::string scene, title;
  double duration = 0.0;  ///< [s]
  std::vector<Figure> figures;
};

std::vector<HardCase> hardCases();

}  // namespace softgauss::app

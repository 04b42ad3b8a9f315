// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Runs of a hard case, and what they come to.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/stability_report/cases.hpp"

namespace softgauss::app {

/// What one engine did.
struct Outcome {
  bool ran = false;                          ///< it could load the scene
  std::optional<double> diverged;            ///< when [s]
  std::vector<double> figures;               ///< in their units
  std::vector<std::vector<double>> courses;  ///< of each figure, at every step

  bool holds(const HardCase& hard, std::size_t figure) const {
    return !diverged && std::abs(figures[figure]) <= hard.figures[figure].bound;
  }
};

/// A case with steps of `timestep` and its initial state, without what `mechanisms` leaves out.
/// Throws ModelError.
Model loadCase(const std::filesystem::path& scenes, const HardCase& hard, double timestep,
               State& state, const MechanismSet& mechanisms = MechanismSet::all());

int stepsOf(const HardCase& hard, double timestep);

/// `advance` brings stage.state forward by one step; false: it cannot.
Outcome runCase(Stage& stage, const HardCase& hard, const std::function<bool()>& advance);

/// Ours.
Outcome runOurs(const std::filesystem::path& scenes, const HardCase& hard, double timestep,
                const MechanismSet& mechanisms = MechanismSet::all());

}  // namespace softgauss::app

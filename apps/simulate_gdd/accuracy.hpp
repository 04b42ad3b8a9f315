// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `--accuracy`: integrator, step and solver tolerance by a measured trial on the scene.

#include <stdexcept>
#include <string>

#include "apps/simulate_gdd/scene.hpp"

namespace softgauss::app {

/// No setting can promise the accuracy: exit code 2.
class AccuracyError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Tries settings on the scene under its own goals, controls and wrenches, as long as the run where
/// that may be, and sets the options of scene.model to the choice. Returns what it chose and what
/// was tried, in one line. Throws AccuracyError where no setting can promise it.
std::string chooseAccuracy(const SimulateOptions& options, Scene& scene);

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// `--accuracy`: integrator, step and solver tolerance by a measured trial on the scene.

#include "apps/shared/setting.hpp"
#include "apps/simulate_gdd/scene.hpp"

namespace softgauss::app {

/// Tries settings on the scene for as long as the run, 2 s at most, under its own goals, controls
/// and wrenches, and sets the options of scene.model to the choice. Returns what it chose, in one
/// line. Throws ModelError where no setting can promise that accuracy.
std::string chooseAccuracy(const SimulateOptions& options, Scene& scene);

}  // namespace softgauss::app

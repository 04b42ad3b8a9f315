// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From the command line to a scene and its goals.

#include <memory>
#include <string>

#include "apps/simulate_gdd/options.hpp"
#include "softgauss/io/simulation/scene.hpp"

namespace softgauss::app {

/// What loading is to know of the command line.
SimulationOptions loadOptions(const SimulateOptions& options);

/// Throws ModelError and UsageError.
std::unique_ptr<Scene> loadScene(const SimulateOptions& options);

/// What the scene and the options ask of the control: its solver, what the actuators can do, and
/// the goals of the scene file, of --goals and of the command line, the latter with a weak posture
/// and virtual damping (26); no goals where the motion is passive or driven by torques. Throws
/// ModelError.
void setUp(const SimulateOptions& options, const Scene& scene,
           gdd::GoalDirectedController& controller);

/// The text of --explain.
std::string explainScene(const Scene& scene);

}  // namespace softgauss::app

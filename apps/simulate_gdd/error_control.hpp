// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which integrator moves a scene on, and how its error is controlled: what the command line says
/// over what the scene file says. A setting that would change nothing is refused.

#include "apps/simulate_gdd/options.hpp"
#include "io/scene.hpp"

namespace softgauss::app {

/// Sets the integrator, Options::stepDoubling and Options::integrationTolerance in `builder`, which
/// holds those of the scene file. Where nobody names an integrator, --integration-tolerance asks
/// for dormand-prince, and goals for the leapfrog, which moves as they have been solved;
/// `hasGoals`: of the scene or the command line. --integrator takes the scene's error control off
/// where it has none of that kind. Returns warnings, which say so. Throws UsageError.
std::vector<std::string> setErrorControl(const SimulateOptions& options,
                                         const io::IntegrationKeys& scene, bool hasGoals,
                                         ModelBuilder& builder);

}  // namespace softgauss::app

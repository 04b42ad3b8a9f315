// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Which integrator moves a scene on, and how its error is controlled: what the caller says over
/// what the file says. A setting that would change nothing is refused.

#include "softgauss/io/scene.hpp"
#include "softgauss/io/simulation/options.hpp"

namespace softgauss {

/// Sets the integrator, Options::stepDoubling and Options::integrationTolerance in `o`, which holds
/// those of the file. Where nobody names an integrator, an integration tolerance asks for
/// dormand-prince. An integrator of the caller's takes the file's error control off where it has
/// none of that kind. Returns warnings, which say so. Throws OptionError.
std::vector<std::string> setErrorControl(const SimulationOptions& options,
                                         const io::IntegrationKeys& file, Options& o);

}  // namespace softgauss

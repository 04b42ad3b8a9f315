// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The options --checkpoint, --checkpoint-every, --resume.

#include "apps/simulate_gdd/options.hpp"

namespace CLI {
class App;
}

namespace softgauss::app {

void addCheckpointOptions(CLI::App& app, SimulateOptions& options);
/// What they mean together with the others, which are read; and what all of them ask for, for a
/// run that is to be gone on with. Throws UsageError.
void finishCheckpointOptions(const CLI::App& app, SimulateOptions& options);

}  // namespace softgauss::app

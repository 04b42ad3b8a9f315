// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Options of plans: --plan, --mpc.

#include "apps/simulate_gdd/command_line.hpp"

namespace softgauss::app {

/// Adds them to the command line; `options` must outlive it.
void addPlanOptions(CLI::App& app, SimulateOptions& options);

/// Checks them, once it is parsed. Throws UsageError.
void finishPlanOptions(const CLI::App& app, SimulateOptions& options);

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/simulate_batch/batch_options.hpp"
#include "apps/simulate_batch/ranks.hpp"
#include "apps/simulate_gdd/run.hpp"

namespace softgauss::app {

/// Runs the sweep, or one run of it. Throws ModelError and UsageError on bad input,
/// std::runtime_error where an output cannot be written.
ExitCode runBatch(const BatchOptions& options, Ranks& ranks);

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The simulation loop of simulate_gdd: step, record, report.

#include "apps/simulate_gdd/scene.hpp"

namespace softgauss::app {

/// Exit codes of simulate_gdd.
enum ExitCode {
  kDone = 0,
  kInternalError = 1,
  kBadInput = 2,
  kCannotContinue = 3,
  kInterrupted = 130
};

/// Runs the scene for options.duration and writes the outputs that were asked for, also when the
/// run ends early. Throws ModelError on bad input, std::runtime_error when a file cannot be
/// written.
ExitCode run(const SimulateOptions& options, Scene& scene);

}  // namespace softgauss::app

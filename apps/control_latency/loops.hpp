// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Closed loops whose contacts change: what a controller meets on a robot.

#include <functional>
#include <string>
#include <vector>

#include "softgauss/io/simulation/options.hpp"

namespace softgauss::app {

std::vector<std::string> loopNames();

struct LoopTimes {
  std::vector<double> us;  ///< of each control [µs]
  long budgetMet = 0;      ///< controls that ended with GddStatus::iterationLimit
  long uncertified = 0;    ///< with another status that is no certificate
  long pageFaults = 0;     ///< within the timed calls
};

/// `cycles` controls of the loop of that name; `faults` counts the process's page faults. Throws
/// ModelError where data/ is not found, StepError where a step is refused.
LoopTimes runLoop(const std::string& name, const SimulationOptions& options, int cycles,
                  const std::function<long()>& faults);

}  // namespace softgauss::app

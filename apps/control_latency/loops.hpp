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
  long counted = 0;        ///< by `count`, within the timed calls and the steps between them
};

/// `cycles` controls of the loop of that name, in `folder`, where data/ is; `count` is what the
/// process has done so often, such as page faults. Throws ModelError where data/ is not found,
/// StepError where a step is refused.
LoopTimes runLoop(const std::string& name, const std::string& folder,
                  const SimulationOptions& options, int cycles, const std::function<long()>& count);

}  // namespace softgauss::app

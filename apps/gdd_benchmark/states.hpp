// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Recorded states with contacts, for a referee: another engine that is given state and control and
/// tells the acceleration (tests/mujoco_reference, tests/parity).

#include <filesystem>

#include "apps/gdd_benchmark/dataset.hpp"

namespace softgauss::app {

/// Writes `count` of the records that have contacts, evenly spread over the run, to
/// `folder`/<robot>_<weight>.json; all of them where there are fewer. Throws std::runtime_error.
void writeStates(const Robot& robot, const Dataset& dataset, double weight, int count,
                 const std::filesystem::path& folder);

}  // namespace softgauss::app

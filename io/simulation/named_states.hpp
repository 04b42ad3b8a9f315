// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Configurations of a scene by name, from the SRDFs of its robots.

#include <string>
#include <utility>
#include <vector>

#include "softgauss/io/simulation/scene.hpp"

namespace softgauss {

/// Each state of each SRDF and its q (nq): the robot's joints as the state has them, the robot as
/// high above the ground as at the start, all else as at the start. The states of a robot that has
/// a name are called ROBOT/NAME.
std::vector<std::pair<std::string, VectorX>> namedStates(const Scene& scene);

}  // namespace softgauss

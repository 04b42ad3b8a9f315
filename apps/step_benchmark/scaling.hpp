// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How the cost of a step grows with links, free bodies, contacts and robots.

#include <map>
#include <string>
#include <vector>

#include "apps/step_benchmark/ladder.hpp"

namespace softgauss::app {

/// Humanoids that stand in rows on a ground, 2.5 m apart.
ModelBuilder humanoidsOnGround(const std::string& robots, int count);
Model humanoids(const std::string& robots, int count);
std::unique_ptr<Scene> makeHumanoids(const std::string& robots, int count);
/// freeBoxes() that lie on a ground.
ModelBuilder boxesOnGround(int count, double spacing);

/// Named what_count: chains of links, free boxes far apart, boxes on the ground, humanoids on it.
std::vector<Rung> scaling(const std::string& robots);

/// The exponent p of time ∝ countᵖ by least squares on logarithms, over the counts of each `what`,
/// from figures named scaling_what_count.in_turn.us.
std::map<std::string, double> exponents(const std::map<std::string, double>& figures);

}  // namespace softgauss::app

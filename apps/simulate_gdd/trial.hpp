// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What each effect of a scene costs, by a short trial.

#include <map>
#include <string>

#include "apps/simulate_gdd/scene.hpp"
#include "softgauss/io/explain.hpp"

namespace softgauss::app {

/// Steps the scene from its start, passively, with every effect; and the same states once more
/// without each effect that runs. The cost is the median of the differences. Takes about half a
/// second at most, and one state at least.
std::map<std::string, io::EffectCost> tryEffects(const Scene& scene);

}  // namespace softgauss::app

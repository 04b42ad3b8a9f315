// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The ladder: each effect alone, on the same base.
///
/// Bases are a fixed arm of 7 hinges, a floating humanoid, and 20 free boxes. `nothing` has gravity
/// and inertial forces; `plainarm` is the arm with the Coriolis forces of the step's start; every
/// other rung is that and one effect, at the same state.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/step_benchmark/scenes.hpp"

namespace softgauss::app {

struct Rung {
  std::string name;  ///< base_effect
  std::function<std::unique_ptr<Scene>()> make;
};

/// `robots`: the folder of arm.urdf and humanoid.urdf.
std::vector<Rung> ladder(const std::string& robots);

/// The rung of that name.
std::unique_ptr<Scene> makeRung(const std::string& robots, const std::string& name);

}  // namespace softgauss::app

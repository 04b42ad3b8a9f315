// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Energy and momentum over a long time: 10 s at 2 ms, every integrator of both engines.

#include <filesystem>
#include <vector>

#include "apps/accuracy_cost/engine_under_test.hpp"

namespace softgauss::app {

struct Drift {
  std::string problem;
  Method method;
  double energy = 0.0;  ///< largest |E − E₀| over what the scene can turn into motion; ∞: diverged
  double last = 0.0;      ///< (E − E₀) at the end, likewise
  double momentum = 0.0;  ///< largest change of angular momentum over its size; of free trees only
};

/// Of the problems that nothing brakes. Prints a table and writes drift.csv.
void measureDrifts(const std::filesystem::path& folder, const std::vector<Problem>& problems);

}  // namespace softgauss::app

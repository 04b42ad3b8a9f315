// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What simulate_gdd --accuracy chooses for a problem: its own trials, over the whole motion, with
/// its own period and longest step. Forces of the problem become a table of controls.

#include <filesystem>
#include <string>

#include "apps/accuracy_cost/engine_under_test.hpp"

namespace softgauss::app {

struct UserChoice {
  bool found = false;
  std::string told;  ///< what simulate_gdd prints, or why it promises nothing
  Method method;
  double h = 0.0;  ///< [s]
};

/// For a problem of one window. The table, if there is one, is written into `folder`.
UserChoice chooseAsUser(const Problem& problem, double accuracy,
                        const std::filesystem::path& folder);

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The exhaustive search: the fastest setting of the table for an accuracy.

#include <string>
#include <vector>

#include "apps/accuracy_cost/study.hpp"

namespace softgauss::app {

struct Best {
  const Result* result = nullptr;  ///< null: none is as accurate, or references do not tell
  double referenceError = 0.0;     ///< smallest of those tried [m]; ∞: the engine is not there
};

/// Of one engine, by references that tell. Settings with other cones than the problem's are another
/// model of contact, and do not count.
Best bestOf(const std::vector<Result>& results, const std::string& problem, double error,
            const std::string& engine);

/// Whether a setting simulates the problem itself, and not another model of its contacts.
bool sameModel(const Method& method);

}  // namespace softgauss::app

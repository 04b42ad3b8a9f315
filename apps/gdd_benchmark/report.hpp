// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The paper's two tables of section VI, with its own figures beside, as text and as JSON.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/gdd_benchmark/statistics.hpp"

namespace softgauss::app {

/// Text of one robot at one goal weight.
std::string tables(const Robot& robot, const Dataset& dataset, const Replay& replay);

/// The same figures. Keys that end in `_us` or hold a ratio of times are of the clock; all others
/// follow from the seed.
nlohmann::ordered_json figures(const Robot& robot, const Dataset& dataset, const Replay& replay);

}  // namespace softgauss::app

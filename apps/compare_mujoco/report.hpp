// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The comparison of one robot as text.

#include <nlohmann/json.hpp>

namespace softgauss::app {

/// Prints the figures that `--json` writes.
void printComparison(const nlohmann::ordered_json& result);

}  // namespace softgauss::app

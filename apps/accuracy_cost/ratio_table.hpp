// SPDX-License-Identifier: Apache-2.0
#pragma once

/// For each problem and error the fastest setting of either engine, as Markdown.

#include <filesystem>

#include "apps/accuracy_cost/study.hpp"

namespace softgauss::app {

/// Writes accuracy_table.md. Where MuJoCo's best is faster the last column is red and says by how
/// much.
void writeRatioTable(const std::filesystem::path& folder, const std::vector<Problem>& problems,
                     const std::vector<Result>& results);

}  // namespace softgauss::app

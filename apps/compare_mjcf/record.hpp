// SPDX-License-Identifier: Apache-2.0
#pragma once

/// MuJoCo's numbers as JSON.

#include "apps/compare_mjcf/numbers.hpp"

namespace softgauss::app {

void writeRecord(const MjcfNumbers& numbers, const std::filesystem::path& file);
/// Throws std::runtime_error.
MjcfNumbers readRecord(const std::filesystem::path& file);

}  // namespace softgauss::app

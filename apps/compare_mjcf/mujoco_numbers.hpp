// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/compare_mjcf/numbers.hpp"

namespace softgauss::app {

inline constexpr int kMjcfStates = 10;

/// By MuJoCo, in seeded random states. Throws ModelError with MuJoCo's own message where it refuses
/// the file.
MjcfNumbers mujocoNumbers(const std::filesystem::path& file);

/// Of the file alone: MuJoCo reads it. Throws as mujocoNumbers().
int mujocoDofs(const std::filesystem::path& file);

std::string mujocoVersion();

}  // namespace softgauss::app

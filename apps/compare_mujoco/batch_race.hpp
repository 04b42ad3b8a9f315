// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Many runs of one scene on one core: our Rollout beside MuJoCo's steps in a plain loop over the
/// same starts.

#include <filesystem>

#include "apps/compare_mujoco/scene_race.hpp"

namespace softgauss::app {

struct BatchChoice {
  int runs = 32;
  int steps = 200;
  int rounds = 12;
};

/// Times of a step of a run [µs]: of both the least of the rounds, in turn. A run starts with the
/// velocities of joints off by normal numbers times 0.1; nothing drives it. Ours keep q of each
/// step, MuJoCo's nothing.
RaceTimes raceBatch(const std::filesystem::path& robot, const BatchChoice& choice);

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A freely swinging chain at equal error: our default beside MuJoCo's cheapest way to its error.
///
/// Both are measured as accuracy_cost does it, against the same reference. MuJoCo's ways are its
/// integrators at step sizes of halves; between two of them time and step are powers of the error.

#include <string>

#include "apps/compare_mujoco/scene_race.hpp"

namespace softgauss::app {

struct EqualError {
  RaceTimes times;      ///< of 2 ms of the motion [µs]
  double error = 0.0;   ///< of ours, root mean square over links and times [m]
  double theirs = 0.0;  ///< of MuJoCo's default at the same step [m]
  std::string way;      ///< of MuJoCo: integrator and step
  std::string refused;  ///< why there is no figure; empty: there is
};

/// A chain that hangs sideways at first, for `periods` of 32 ms; each time is the least of
/// `repeats`.
EqualError swingAtEqualError(int links, int periods, int repeats);

}  // namespace softgauss::app

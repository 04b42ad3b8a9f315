// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Times of a whole step of both engines, each on its own path from the same start.

#include <functional>
#include <stdexcept>

#include "softgauss/engine/engine.hpp"

namespace softgauss::app {

/// A simulation has become non-finite; exit code 3.
class NotFinite : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct StepTimes {
  double ours = 0.0, mujoco = 0.0;  ///< of a step, means over the path [µs of CPU time]
};

/// The model in ours by its options, and in MuJoCo by its defaults: runs of `duration` [s] from
/// `initial` with the forces that `control` gives at a time, in turn, and of each engine the
/// shortest of `rounds`. Throws ModelError, and NotFinite where ours is.
StepTimes timeSteps(const Model& model, const State& initial, double duration, int rounds,
                    const std::function<VectorX(double)>& control);

/// The library that is linked, its version and what compiled it, as it says itself.
std::string mujocoBuild();

}  // namespace softgauss::app

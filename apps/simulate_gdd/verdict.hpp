// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Why a goal was not reached: what held the robot back towards the end of the run.

#include <string>
#include <vector>

#include "engine/model/state.hpp"
#include "gdd/problem.hpp"
#include "io/summary.hpp"

namespace softgauss::app {

class Verdict {
 public:
  Verdict(const Model& model, const gdd::ControlBox& box);

  /// Forces on joints and commands of the box's actuators as applied, and the state after the step.
  void observe(const VectorX& tau, const VectorX& commands, const State& state);

  /// A sentence for each goal that closed less than 80 % of its initial distance.
  std::vector<std::string> unreached(const std::vector<io::GoalOutcome>& goals) const;

 private:
  std::string heldBack() const;

  const Model& model_;
  const gdd::ControlBox& box_;
  VectorX saturated_;  ///< (nv) share of recent steps at the effort limit, exponentially weighted
  VectorX full_;       ///< the same of actuators and the bounds of their commands
  VectorX speed_;      ///< (nv) last velocity
  VectorX q_;          ///< (nq) last configuration
};

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Why a goal was not reached: what held the robot back towards the end of the run.

#include <string>
#include <vector>

#include "engine/model/state.hpp"
#include "io/summary.hpp"

namespace softgauss::app {

class Verdict {
 public:
  explicit Verdict(const Model& model);

  /// Control u as applied, and the state after the step.
  void observe(const VectorX& u, const State& state);

  /// A sentence for each goal that closed less than 80 % of its initial distance.
  std::vector<std::string> unreached(const std::vector<io::GoalOutcome>& goals) const;

 private:
  std::string heldBack() const;

  const Model& model_;
  VectorX saturated_;  ///< (nv) share of recent steps at the effort limit, exponentially weighted
  VectorX speed_;      ///< (nv) last velocity
  VectorX q_;          ///< (nq) last configuration
};

}  // namespace softgauss::app

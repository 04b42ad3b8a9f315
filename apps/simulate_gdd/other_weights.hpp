// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What goals that other weights hold back would leave if they weighed more.

#include "apps/simulate_gdd/verdict.hpp"
#include "softgauss/gdd/other_weight.hpp"

namespace softgauss::app {

class OtherWeights {
 public:
  /// They have to live as long. `standing`: what was seen of the run.
  OtherWeights(const Model& model, gdd::GoalDirectedController& controller,
               const Standing& standing)
      : model_(model), controller_(controller), standing_(standing) {}

  /// Of the first goals that are not reached and are held back by weights more than by all else:
  /// the outcome gets a weight that leaves at most half as much, where one is found with which the
  /// robots come to rest and go on standing, and the reason says so.
  void tell(std::vector<GoalRecord::Track>& tracks, const SeenStep& end);

 private:
  std::optional<io::GoalOutcome::OtherWeight> find(const GoalRecord::Track& track, double& weight,
                                                   const SeenStep& end);
  std::optional<double> leaves(const GoalRecord::Track& track, double& weight, double tried,
                               const SeenStep& end);

  const Model& model_;
  gdd::GoalDirectedController& controller_;
  const Standing& standing_;
  std::optional<gdd::OtherWeight> trial_;
};

}  // namespace softgauss::app

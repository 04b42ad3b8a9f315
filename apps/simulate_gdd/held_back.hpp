// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What holds goals back that are not reached, each by its share, in names of the scene.

#include <optional>
#include <string>
#include <vector>

#include "apps/simulate_gdd/goal_record.hpp"
#include "softgauss/gdd/goal_balance.hpp"

namespace softgauss::app {

struct SeenStep;

/// Of a goal that is not reached.
struct HeldGoal {
  std::vector<io::GoalOutcome::Cause> causes;  ///< the largest first; their shares add up to 1
  /// What it pulls with, over what it would at rest (gdd::Opposition::held); 1 where nobody knows.
  double held = 1.0;
  bool singular = false;  ///< gdd::Opposition::singular
  double weighed = 0.0;   ///< share of what its own weight is set against
};

class HeldBack {
 public:
  /// Both have to live as long.
  HeldBack(const Model& model, const gdd::GoalDirectedController& controller)
      : model_(model), controller_(controller) {}

  /// After this step, or at its goal's end where that has come.
  HeldGoal of(const GoalRecord::Track& track, const SeenStep& step);
  /// The steps that were seen before are over.
  void forget() { solvedAt_.reset(); }

  /// "a 97 %, b 3 %": those of at least one per cent.
  static std::string text(const std::vector<io::GoalOutcome::Cause>& causes);

 private:
  std::string nameOf(const gdd::Opponent& opponent, int goal) const;

  const Model& model_;
  const gdd::GoalDirectedController& controller_;
  std::optional<gdd::GoalBalance> balance_;
  std::optional<double> solvedAt_;  ///< time for which balance_ is solved [s]
  bool solved_ = false;             ///< it has a solution there
};

}  // namespace softgauss::app

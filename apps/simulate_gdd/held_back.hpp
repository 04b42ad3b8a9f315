// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What holds goals back that are not reached, in sentences.

#include <optional>
#include <string>
#include <vector>

#include "apps/simulate_gdd/goal_record.hpp"
#include "softgauss/io/held_back.hpp"

namespace softgauss::app {

struct SeenStep;

class HeldBack {
 public:
  /// Both have to live as long.
  HeldBack(const Model& model, const gdd::GoalDirectedController& controller)
      : model_(model), controller_(controller) {}

  /// After this step, or at its goal's end where that has come.
  io::HeldBack of(const GoalRecord::Track& track, const SeenStep& step);
  /// The steps that were seen before are over.
  void forget() { solvedAt_.reset(); }

  /// "a 97 %, b 3 %": those of at least one per cent.
  static std::string text(const std::vector<io::GoalOutcome::Cause>& causes);

 private:
  const Model& model_;
  const gdd::GoalDirectedController& controller_;
  std::optional<gdd::GoalBalance> balance_;
  std::optional<double> solvedAt_;  ///< time for which balance_ is solved [s]
  bool solved_ = false;             ///< it has a solution there
};

}  // namespace softgauss::app

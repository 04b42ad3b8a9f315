// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A goal: a cost on the acceleration, renewed at every step (section V of the paper).
///
/// To add a kind of goal: write a file in goals/ with a class that adds its terms to the cost.

#include <optional>
#include <string>

#include "engine/step/data.hpp"
#include "gdd/cost.hpp"

namespace softgauss::gdd {

/// What a goal may read: the stages of this step up to the rows.
struct GoalContext {
  const Model& model;
  const State& state;
  const Data& data;
};

class Goal {
 public:
  virtual ~Goal() = default;
  /// As the summary names it, e.g. "reach right_hand".
  virtual std::string name() const = 0;
  /// Adds the cost of this goal at the present state.
  virtual void addCost(const GoalContext& context, GoalCost& cost) const = 0;
  /// Distance from the goal [m]; nothing for a goal that is no place.
  virtual std::optional<double> error(const GoalContext&) const { return std::nullopt; }
};

}  // namespace softgauss::gdd

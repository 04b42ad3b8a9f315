// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A plan that is acted out by goal directed dynamics, and made anew while it is.
///
///   planning::RecedingHorizon horizon(planner, {.period = 0.02});
///   horizon.attach(controller);
///   horizon.begin(state);                     // the planner has a feasible plan from here
///   for (;;) { horizon.update(state);  controller.step(model, input, state, data, &contacts); }
///
/// A step of the simulator, however fine, has the goal (22) of a step of the plan: V where the plan
/// is one of its steps later, between two knots by both of theirs, with the controls at the plan's
/// price. Every `period` the plan moves on by as much and begins at the state that there is: one
/// goal directed pass, iterations of phase F, and the value models about what they give. It stops
/// in time where seconds or iterations are used up, for each is a feasible plan. A tick that fails
/// leaves the plan before, on which the goal goes on. Without a period nothing is planned anew.

#include "softgauss/gdd/planning/planner.hpp"

namespace softgauss::planning {

struct HorizonOptions {
  double period = 0.0;         ///< from tick to tick [s], at most a step of the plan; 0: no ticks
  int iterations = 0;          ///< of phase F in a tick, beside its pass, at most
  double seconds = kInfinity;  ///< of wall time, after which a tick begins no other iteration
};

struct HorizonReport {
  int ticks = 0, failed = 0;
  double seconds = 0.0, longest = 0.0;  ///< of all ticks, of the longest [s]
  double cost = 0.0;                    ///< of the plan there is
};

class RecedingHorizon {
 public:
  /// The planner must outlive this. Throws ModelError where an option is out of its range.
  explicit RecedingHorizon(Planner& planner, const HorizonOptions& options = {});

  /// Gives a controller of the same model the goal, the price of control and the bounds of the
  /// plan. Goals that it has stay.
  void attach(gdd::GoalDirectedController& controller);
  /// The planner's plan begins now. False where it has none that is feasible.
  bool begin(const State& state);
  /// Before a step from `state`: plans where a tick is due, and sets the goal.
  void update(const State& state);
  const HorizonReport& report() const { return report_; }

 private:
  void tick(const State& state);
  void setGoal(double time);

  Planner& planner_;
  HorizonOptions options_;
  gdd::QuadraticValue* goal_ = nullptr;  ///< of the controller
  HorizonReport report_;
  Knot start_;
  VectorX along_;
  double begun_ = 0.0;  ///< when the plan there is begins
  double due_ = kInfinity;
};

}  // namespace softgauss::planning

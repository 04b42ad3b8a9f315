// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A plan that is acted out by goal directed dynamics, and made anew while it is.
///
///   planning::RecedingHorizon horizon(planner, {.period = 0.02});
///   horizon.attach(controller);
///   horizon.begin(state);                     // the planner has a feasible plan from here
///   for (;;) { horizon.update(state);  controller.step(model, input, state, data, &contacts); }
///
/// Knots stay where they are in time. A step of the simulator, however fine, has the goal (22) of
/// what is left of a step of the plan, r ≤ h: with the state after r, controls at r times the
/// plan's price, and V of the knot that comes then,
///
///   min ½ r uᵀR u + V_{t+1}(q⁺, v⁺)                                                         (P.9)
///
/// On the plan that is the plan's own control, at every instant; and for r → 0 it is
/// u = −R⁻¹ (∂v̇/∂u)ᵀ ∂V/∂v, optimal control in continuous time.
///
/// Every `period` it is planned anew: the state that there is is taken to the next knot towards V,
/// by the steps of the simulator, and from there on goes the plan, moved on by a knot where one has
/// passed: one goal directed pass, iterations of phase F, and the value models about what they
/// give. It stops in time where seconds or iterations are used up, for each is a feasible plan.
///
/// Near where a foot lifts or lands, a pass in the plan's steps may be lost, its cost many times
/// what V has promised. Such a tick fails (FeasiblePhase::shift()): it leaves the plan before, on
/// which the goal goes on. After three in a row what the pass gives is taken, for then the world is
/// not as it was planned. Without a period nothing is planned anew. Targets go by the time since
/// begin() (PlanCost::passed).

#include "softgauss/gdd/planning/planner.hpp"

namespace softgauss::planning {

struct HorizonOptions {
  double period = 0.0;         ///< from tick to tick [s], at most a step of the plan; 0: no ticks
  int iterations = 0;          ///< of phase F in a tick, beside its pass, at most
  bool keepsEnd = false;       ///< final terms count from the first plan's end on (PlanCost)
  double seconds = kInfinity;  ///< of wall time, after which a tick begins no other iteration
};

struct HorizonReport {
  int ticks = 0, failed = 0;
  double seconds = 0.0, longest = 0.0;  ///< of all ticks, of the longest [s]
  double last = 0.0;                    ///< of the last one [s]
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
  /// Nothing is asked for any more, until a plan begins.
  void end();
  bool acts() const { return acts_; }
  /// The planner's costs are others: from the next tick on it is planned for them.
  void takeCosts() { costsChanged_ = true; }
  /// Before a step from `state`: plans where a tick is due, and sets the goal.
  void update(const State& state);
  const HorizonReport& report() const { return report_; }

 private:
  /// Goal directed steps through what is left of a step of the plan.
  struct Prediction {
    explicit Prediction(const Planner& planner);
    Model model;
    std::unique_ptr<ContactSource> contacts;
    Data data;
    gdd::GoalDirectedController controller;
    gdd::QuadraticValue* goal;
    State state;
  };

  gdd::QuadraticValue* addGoal(gdd::GoalDirectedController& controller) const;
  void tick(const State& state);
  bool predict(const State& state);
  void setGoal(double time, gdd::QuadraticValue& goal) const;
  double knotAt(double time) const;

  Planner& planner_;
  HorizonOptions options_;
  gdd::QuadraticValue* goal_ = nullptr;  ///< of the controller
  std::unique_ptr<Prediction> prediction_;
  HorizonReport report_;
  Knot start_;
  double begun_ = 0.0;  ///< when the first plan began
  int first_ = 0;       ///< knot since then at which the plan there is begins
  int lostInARow_ = 0;  ///< ticks
  double due_ = kInfinity;
  bool acts_ = false, costsChanged_ = false;
};

}  // namespace softgauss::planning

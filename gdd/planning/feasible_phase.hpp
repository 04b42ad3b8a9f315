// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Phase F: a plan whose every knot the actuators can cause, and whose cost never rises.
///
/// Backward (P.5). Forward, at the state that has been reached, goal directed dynamics find the
/// control of every step, with kinks and bounds exact (22):
///
///   min ½ (g − ĝ)ᵀR_ρ(g − ĝ) + V_{t+1}(q⁺, v⁺),   g_z = 0, u in its bounds
///   R_ρ = h R + ρ D,   R_ρ ĝ = ρ D (ū + K δx) + (1 − α) Q_u,   D = diag Q_uu               (P.6)
///
/// ū of the trajectory before. The last term makes α = 0 give that trajectory again. Where such a
/// pass does not lower the cost, plain controls ū + α k + K δx do at times; both are tried at every
/// α, and ρ is raised where none falls.

#include "softgauss/gdd/goal_directed_step.hpp"
#include "softgauss/gdd/goals/quadratic_value.hpp"
#include "softgauss/gdd/planning/trajectory.hpp"

namespace softgauss::planning {

struct FeasibleOptions {
  int lengths = 7;            ///< of α = 1, 0.4, 0.16, …
  double mostSpeed = 1e3;     ///< a pass that comes to a faster one has failed [rad/s, m/s]
  bool goalDirected = true;   ///< passes by goal directed dynamics
  bool plainControls = true;  ///< passes by plain controls
};

class FeasiblePhase {
 public:
  FeasiblePhase(const Problem& problem, KnotThreads& threads);

  /// Without a trajectory; what the problem asks for has perhaps changed.
  void reset(const FeasibleOptions& options = {});
  /// A pass on these value models about any trajectory, which need not be feasible: what it gives
  /// is taken where it is finite and, unless `always`, better than what there is. False where not.
  bool take(const Trajectory& about, const std::vector<ValueModel>& values, bool always = false);
  /// A feasible trajectory with its value models, found before.
  void adopt(const Trajectory& x, const std::vector<ValueModel>& values);
  /// The trajectory of these controls (nv, N of them), clamped, from a state. False where it is not
  /// finite.
  bool rollOut(const Knot& start, const std::vector<VectorX>& controls);
  /// Moves the trajectory, its value models and feedback on by some knots, and makes a feasible one
  /// of them from `start`: towards V, by the controls and feedback that there were, or between
  /// both, the first that does not cost more than three times what V promises there. False where
  /// all do or are not finite: then nothing has changed but what passes have tried. `whatever`: the
  /// least dear of them is taken all the same.
  bool shift(int knots, const Knot& start, bool whatever);
  /// Value models and feedback about the trajectory as it is. False where no control has a minimum,
  /// or where the models' largest curvature is more than 10⁵ times what it was: then those before
  /// stay. (Where a foot is about to lift or to rock, derivatives can be such that the models of
  /// the knots before it grow without bound, to 10¹⁴, and no pass follows these.)
  bool refresh();
  /// The problem's costs have changed: finds that of the trajectory, and refreshes the models.
  bool takeCosts();
  /// One iteration; false where no step was found, which raises ρ for the next.
  bool iterate();

  bool hasTrajectory() const { return has_; }
  const Trajectory& trajectory() const { return x_; }
  const std::vector<ValueModel>& values() const { return values_; }
  const std::vector<Feedback>& feedback() const { return feedback_; }
  double stepLength() const { return alpha_; }
  double rho() const { return rho_; }
  double promised() const { return promised_; }  ///< decrease by the model, at α = 1
  /// The knot at which the last backward pass has found a cost or a value model that is not finite;
  /// −1: none.
  int refusedKnot() const { return refusedKnot_; }
  /// The largest of |a of forward dynamics − a of the trajectory| that its controls have, over
  /// max(1, |a|∞), step by step: how far it is from what the engine does.
  double gap();

 private:
  void begin();
  bool backward();
  bool refuse(int knot);
  bool linearise();
  void forgetFeedback();
  void moveOn(int knots);
  bool pass(double alpha, bool goalDirected, Trajectory& y);
  bool solveGoal(int t, Knot& knot, double alpha);
  bool solveControls(int t, Knot& knot, double alpha);
  void difference(const Knot& from, const Knot& to);

  const Problem& problem_;
  KnotThreads& threads_;
  PlanDynamics& dynamics_;  ///< of the calling thread
  FeasibleOptions options_;
  TrajectoryCost cost_;
  BackwardPass backward_;
  gdd::GoalDirectedController controller_;
  gdd::QuadraticValue* value_;
  Trajectory x_, trial_, reference_, best_;
  std::vector<ValueModel> values_, otherValues_;
  std::vector<Feedback> feedback_, otherFeedback_;
  ValueModel knotCost_;
  VectorX R_, metric_, free_, dx_, dq_, du_, control_;
  double rho_ = 0.0, growth_ = 1.0, alpha_ = 0.0, promised_ = 0.0;
  int refusedKnot_ = -1;
  bool has_ = false, fresh_ = true;
};

}  // namespace softgauss::planning

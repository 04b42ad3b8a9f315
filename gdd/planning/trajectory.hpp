// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A trajectory of a plan with its models, and what it costs.

#include "softgauss/gdd/planning/backward_pass.hpp"
#include "softgauss/gdd/planning/knot_threads.hpp"
#include "softgauss/gdd/planning/plan_cost.hpp"

namespace softgauss::planning {

/// What is planned.
struct Problem {
  const Model& model;  ///< with the options of a bare step; h is its timestep
  const PlanCost& cost;
  int knots;             ///< N
  VectorX rootCost;      ///< (nv) of forces that no actuator causes: R where they are allowed
  VectorX lower, upper;  ///< (nv) of τ; 0 where no actuator pulls
  std::vector<int> controlled;

  double h() const { return model.options.timestep; }
  bool isControlled(int dof) const { return model.dofs[idx(dof)].actuated; }
};

/// N + 1 knots, of which the last has a state alone.
class Trajectory {
 public:
  Trajectory(const Problem& problem, const PlanDynamics& dynamics);

  std::vector<Knot> knots;
  double cost = 0.0;       ///< J (P.3) of the controls, root forces apart
  double rootForce = 0.0;  ///< largest |τ| of dofs without an actuator [N, N m]
  double excess = 0.0;     ///< by which τ leaves its bounds, the largest [N, N m]
  int notFinite = -1;      ///< the first knot at which state, force or cost is not; -1: none

  /// Sets q and v of all knots by the exact step from knots[0] by their accelerations. False where
  /// they are not finite.
  bool integrate(const PlanDynamics& dynamics);
  /// q, v, a and tau of another; models stay.
  void copyMotion(const Trajectory& from);
  /// Sets tau of all knots.
  bool findForces(KnotThreads& threads);
};

/// J, and its models knot by knot.
class TrajectoryCost {
 public:
  explicit TrajectoryCost(const Problem& problem)
      : state_(problem.model), kinematics_(problem.model) {}

  /// To be called when the problem's terms have changed.
  void begin(const Problem& problem);

  /// Of a knot's state, h times the running terms, and of the last one the final ones (P.3).
  double value(const Problem& problem, const Knot& knot, int t);
  /// Its slope and curvature (lower triangle). False where they are not finite.
  bool expand(const Problem& problem, const Knot& knot, int t, ValueModel& model);
  /// Sets cost, rootForce, excess and notFinite from q, v and tau.
  void evaluate(const Problem& problem, Trajectory& trajectory);

 private:
  /// f(term, scale) of all that count at a knot.
  template <class F>
  void forTerms(const Problem& problem, int t, const F& f);
  KnotView view(const Problem& problem, const Knot& knot, int t);
  State state_;
  Kinematics kinematics_;
  bool needsKinematics_ = false;
};

}  // namespace softgauss::planning

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What holds a goal back: the slopes that oppose its own where the problem of the goals is solved.
///
/// At a minimum of (8.1) the slopes of all that counts add up to nothing:
///   Σ_k ∇ℓ_k + P w = J_Kᵀμ,   w = R (g − ĝ) + Σ_k W_k g + Cᵀλ,   P = M̂ + Σ_r J_rᵀ s″_r J_r
/// ∇ℓ_k: of goal k, and of motion limits; R and W: prices of force; λ ≠ 0 at bounds of controls,
/// and where no actuator acts; μ: of rows held at breakpoints. Nothing is taken from the solver but
/// the point where it ends: P w = J_Kᵀμ − Σ∇ℓ gives w, w gives λ, and μ is what leaves λ = 0 where
/// a control is within its bounds.
///
/// These are compared along one direction d of acceleration, that in which the goal pulls: −∇ℓ_0
/// by D⁻¹, the inertia of each dof, D = diag M̂; of joints, that of the joint alone that is farthest
/// off. By M̂⁻¹, as accelerations of the goal's own error, what balances it dof by dof could count
/// as its help: a torque at a shoulder may throw the hand the other way. d is the nearest to it, by
/// D, that the controls can cause: d = S δu, S = P⁻¹B. Then (P d)_z = 0, and P w·d is what the
/// controls pay,
///   P w·d = Σ_u (Tᵀw)_u (C P d)_u
/// of which D d, the free motion, is for the price of force and for bounds (what is left out, a
/// torque at one joint that carries another's motion, resists nobody), and J_rᵀ s″_r J_r d for
/// the row r: what it costs more because a contact, or an end of a range, has to give way. So what
/// cannot be moved, and what is held by something that does not resist this goal, takes no share.
/// Shares are of all that opposes and add up to 1.

#include <memory>
#include <string>
#include <vector>

#include "softgauss/gdd/goal_directed_step.hpp"

namespace softgauss::gdd {

/// One of the things that oppose a goal.
struct Opponent {
  enum class Kind : std::uint8_t {
    goal,           ///< `index` of the balance's goals; of its own, what it asks of other joints
    controlCost,    ///< the price of force
    controlLimit,   ///< of the coordinate `index` (problem.hpp)
    range,          ///< end of the range of the dof `index`
    velocityLimit,  ///< of the dof `index`
    contact,        ///< of the geometries `index` and `other`, index < other
    dryFriction,    ///< of the dof `index`
    servo,          ///< of the dof `index`, of a tree that goals do not control
    equality        ///< what joins bodies besides joints
  };
  Kind kind = Kind::goal;
  int index = -1, other = -1;
  double share = 0.0;  ///< of all that opposes, > 0
};

/// What opposes a goal, and how far it is opposed.
struct Opposition {
  std::vector<Opponent> opponents;  ///< the largest share first; empty where the goal does not pull
  /// What the goal still pulls with, over what it would at rest: 1 of what stands still, about 0
  /// where the robot moves as the goal wants.
  double held = 0.0;
  /// Of a reach: no joint moves it towards its place from where it is, so that it does not pull.
  bool singular = false;
};

class GoalBalance {
 public:
  /// Of the controller's goals, limits and prices. Both have to live as long.
  GoalBalance(const Model& model, const GoalDirectedController& controller);

  /// Solves at this state, from its warm start. False where the solve was refused.
  bool solve(const Input& input, const State& state, ContactSource* contacts);

  /// The goals that act, a reach of a pose in two: `goal` and `goal (orientation)`.
  int goalCount() const { return static_cast<int>(terms_.size()); }
  const std::string& goalName(int i) const { return terms_[static_cast<std::size_t>(i)].name; }
  const Goal& goal(int i) const { return *terms_[static_cast<std::size_t>(i)].goal; }
  /// Among them, by the name of its figure, else by the goal; −1: it does not act.
  int find(const Goal& goal, const std::string& name) const;

  /// What opposes goal i. `dof`: its error is that of this dof alone, −1: that of its whole cost.
  Opposition against(int i, int dof = -1);

  /// The largest |λ_i| of a control within its bounds, over the largest of all slopes, both in
  /// units of control: 0 at a minimum, but for rounding.
  double imbalance() const { return imbalance_; }

 private:
  struct Term {
    std::string name;
    const Goal* goal;
    std::unique_ptr<Goal> own;  ///< where it is a part of one
    VectorX slope, price;       ///< ∇ℓ_k, W_k g (nv)
    VectorX still;              ///< ∇ℓ_k at a = v = 0, empty where it follows a line
    /// Of a reach: the largest ∇ℓ·D⁻¹∇ℓ that it would have at this distance, 2 ℓ tr(D⁻¹∇²ℓ); else
    /// 0.
    double most = 0.0;
    double share = 1.0;  ///< of it, what balances leave to act
    int fadesFor = -1;   ///< the term of the balance that leaves least of it
  };
  struct Sum;

  void listTerms(double time);
  void findShares(const State& state);
  VectorX slopeOf(const Term& term, const State& state, const VectorX& a);
  double mostSlope(const VectorX& a);
  void findStillSlopes(const Input& input, State state, ContactSource* contacts);
  bool findAcceleration(const State& state);
  void findSlopes(const State& state);
  void findMultipliers();
  VectorX direction(const VectorX& wish) const;
  void split(const Goal& goal, int dof, VectorX& slope, VectorX& others) const;
  void addRows(const VectorX& d, Sum& sum);

  const Model& model_;
  const GoalDirectedController& controller_;
  Data data_;
  GoalCost cost_;
  ActiveSet activeSet_;
  AugmentedLagrangian augmentedLagrangian_;
  SequentialQuadraticSolve expansion_;
  GravityCompensation holding_;
  WarmStart between_, warm_;
  std::vector<Term> terms_;
  VectorX a_, g_;        ///< the solution
  VectorX motionSlope_;  ///< of the motion limits
  TreeMatrix P_;
  TreeFactor factor_, massFactor_;  ///< of P, of M̂
  VectorX costSlope_, lambda_;      ///< Tᵀ R (g − ĝ), λ, 0 where no bound is met (nv)
  std::vector<char> driven_;        ///< (nv) coordinates that a control chooses
  std::vector<Breakpoint> held_;
  std::vector<VectorX> heldRows_;  ///< J_K
  VectorX mu_;
  VectorX velocity_, inertia_;  ///< v, D (nv)
  double imbalance_ = 0.0;
};

}  // namespace softgauss::gdd

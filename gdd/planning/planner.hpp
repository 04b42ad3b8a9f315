// SPDX-License-Identifier: Apache-2.0
#pragma once

/// AILQR: acceleration-based iterative LQR, which the paper's section IV names.
///
///   planning::Planner planner(model, {.step = 0.05, .knots = 20}, contacts);
///   planner.cost.running.push_back(…);   planner.cost.effort.setConstant(1e-2);
///   const planning::MotionPlan& plan = planner.solve(state.q, state.v);
///
/// Phase I (infeasible_phase.hpp) finds a trajectory in accelerations, through root forces if need
/// be. At every iteration goal directed dynamics make a feasible one of its value models, and
/// phase F (feasible_phase.hpp) goes on from the best of these. A plan is what the actuators can
/// cause: its root forces are 0, its controls in their bounds, and a bare step by them gives it.

#include <functional>
#include <memory>
#include <string_view>

#include "softgauss/gdd/planning/feasible_phase.hpp"
#include "softgauss/gdd/planning/infeasible_phase.hpp"
#include "softgauss/gdd/planning/plan_search.hpp"
#include "softgauss/gdd/planning/planning_contacts.hpp"

namespace softgauss::planning {

struct PlanSteps {
  double step = 0.05;  ///< h [s]
  int knots = 20;      ///< N
  int threads = 1;     ///< over which the knots go; the bits are the same for any number
};

struct PlanOptions {
  int infeasible = 15;         ///< iterations of phase I, at most
  int feasible = 60;           ///< iterations of phase F, at most
  int passEvery = 1;           ///< iterations of phase I from one feasible pass to the next
  double tolerance = 1e-6;     ///< decrease of the cost, over it, at which phase F ends
  double seconds = kInfinity;  ///< of wall time in a stage; then the best feasible plan is taken
  InfeasibleOptions inPhaseI;
  FeasibleOptions inPhaseF;
};

/// From planning contacts to the model's own, margins falling by `factor` a stage. A stage in which
/// the plan is lost, its cost more than `lost` times that of the one before, is repeated nearer to
/// it, by half the way, and so on to 1/16.
struct Continuation {
  PlanningContacts contacts;  ///< of the first stage
  int stages = 0;             ///< between the first and the last, on the model's own contacts
  double factor = 0.95;
  double lost = 2.0;
  int infeasible = 5, feasible = 5;  ///< iterations in each stage but the first and the last
};

enum class PlanStatus {
  converged,       ///< the cost falls by less than the tolerance
  iterationLimit,  ///< or time: the best feasible plan
  interrupted,     ///< by Planner::progress: the best feasible plan there was
  noDescent,       ///< no step lowers the cost: at a kink, or where rounding ends
  infeasible,      ///< no feasible trajectory was found: plan is that of phase I, with root forces
  refused  ///< the start, or what comes of it or what it costs at refusedKnot, is not finite
};
std::string_view planStatusName(PlanStatus status);

struct MotionPlan {
  std::vector<VectorX> q, v;    ///< N + 1 states
  std::vector<VectorX> a, tau;  ///< N accelerations, and the forces on the dofs that cause them
  PlanStatus status = PlanStatus::refused;
  double cost = 0.0;                 ///< J (P.3)
  double rootForce = 0.0;            ///< largest force where nobody pulls [N, N m]
  double gap = 0.0;                  ///< FeasiblePhase::gap()
  int refusedKnot = -1;              ///< where the last model was none (FeasiblePhase), or -1
  double certificate = 0.0;          ///< decrease that the last model promises still, over the cost
  int infeasible = 0, feasible = 0;  ///< iterations of the last stage, phase by phase
  int iterations = 0;                ///< of all stages and tries
  double seconds = 0.0;              ///< wall time
  /// Of the last stage, after each iteration: L of phase I, then J of phase F.
  std::vector<double> costs;
};

class Planner {
 public:
  using Contacts = KnotThreads::Contacts;

  /// Plans with a copy of the model, whose steps are bare and of steps.step; `contacts` makes what
  /// finds its contacts (empty: nothing collides). Throws ModelError where steps are none.
  Planner(const Model& model, const PlanSteps& steps, const Contacts& contacts = {});
  Planner(const Planner&) = delete;

  PlanCost cost;  ///< none; effort is 0.01 on every actuated dof
  /// Called between iterations with the plan's figures so far: the cost, of phase I its Lagrangian,
  /// the root force left and the iterations; where it says false, planning ends with the best
  /// feasible plan there is, on the model's own contacts where that is where it was to end.
  std::function<bool(const MotionPlan&)> progress;
  VectorX rootCost;  ///< (nv) at first, of forces that no actuator causes; a hundred times effort

  /// From a state. `accelerations` (N of nv): where phase I begins; empty: at rest.
  const MotionPlan& solve(const VectorX& q, const VectorX& v, const PlanOptions& options = {},
                          const std::vector<VectorX>& accelerations = {});
  /// The same from a state: a step after another one looks at its acceleration, where it slides.
  const MotionPlan& solve(const State& state, const PlanOptions& options = {},
                          const std::vector<VectorX>& accelerations = {});
  /// On planning contacts first, then stage by stage to those of the model, where the plan ends.
  /// `options` are those of the first and of the last stage.
  const MotionPlan& solve(const State& state, const Continuation& continuation,
                          const PlanOptions& options = {},
                          const std::vector<VectorX>& accelerations = {});
  /// From the plan there is, on the contacts there are, to better ones near it (plan_search.hpp).
  const MotionPlan& search(const State& state, const PlanSearch& search,
                           const PlanOptions& options = {});
  /// Phase F alone, from what goal directed dynamics make of the accelerations where actuators can.
  /// With plain controls alone (FeasibleOptions) that is iLQR over controls.
  const MotionPlan& solveFeasible(const State& state, const PlanOptions& options = {},
                                  const std::vector<VectorX>& accelerations = {});
  /// What finds contacts as plans do, for their model as it is; null where nothing collides.
  std::unique_ptr<ContactSource> contactsFor(const Model& model) const {
    return threads_.contactsFor(model);
  }
  /// What the next plan's contacts are: these, or the model's own.
  void setContacts(const PlanningContacts& contacts);
  void setOwnContacts();

  /// For who goes on with a feasible plan (receding_horizon.hpp): FeasiblePhase::shift(),
  /// iterate(), refresh() and takeCosts(). plan() stays. False where there is none, or where they
  /// are.
  bool moveOn(int knots, const Knot& start, bool whatever) {
    return feasible_.hasTrajectory() && feasible_.shift(knots, start, whatever);
  }
  bool improve() { return feasible_.iterate(); }
  bool refresh() { return feasible_.hasTrajectory() && feasible_.refresh(); }
  bool takeCosts() { return feasible_.hasTrajectory() && feasible_.takeCosts(); }

  const MotionPlan& plan() const { return plan_; }
  const Model& model() const { return *model_; }
  /// Of the model that was given: how the plan is acted out.
  const Options& acting() const { return acting_; }
  /// Value models and feedback about the plan, of phase F.
  const FeasiblePhase& feasible() const { return feasible_; }

 private:
  Problem problem();
  void runInfeasible(const PlanOptions& options, double start);
  void runFeasible(const PlanOptions& options, double start);
  bool mayGoOn(const PlanOptions& options, double start);
  void publish(const Trajectory& x);
  void setPrices();
  bool start(const State& state, const PlanOptions& options,
             const std::vector<VectorX>& accelerations);
  void run(const State& state, const PlanOptions& options,
           const std::vector<VectorX>& accelerations, bool goesOn);
  void finish(const PlanOptions& options, double begin);
  void keep();
  void settle(const State& state, const PlanOptions& options);
  void takeKept();
  template <class F>
  void makeContacts(const F& material);

  Options acting_;
  std::unique_ptr<Model> model_;
  MechanismSet mechanisms_ = MechanismSet::none();  ///< of the model's own contacts
  std::vector<Material> own_;  ///< of the model's geometries, then of its pairs
  int knots_;
  KnotThreads threads_;
  Problem problem_;
  InfeasiblePhase infeasible_;
  FeasiblePhase feasible_;
  Trajectory begin_;
  Trajectory kept_;  ///< of the stage before, with its accelerations and value models
  std::vector<VectorX> keptAccelerations_;
  std::vector<ValueModel> keptValues_;
  MotionPlan plan_;
  bool stopped_ = false;
};

}  // namespace softgauss::planning

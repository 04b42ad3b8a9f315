// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The plan of a scene, made and acted out in its simulator.
///
///   PlanControl control(scene, io::readPlanTask(file, scene.model, scene.initial), receding);
///   control.solve();
///   control.attach(controller);
///   control.begin(state);
///   for (;;) { control.update(state);  controller.step(…);  control.addStep(controller.control,
///   h); }
///
/// What the motion has cost is the plan's own sum (P.3): the terms of states at its knots, those of
/// control all along, final ones where the plan ends. A receding one is made anew at the rate of
/// the task, on the scene's own contacts; where the task says so, on planning contacts, with a
/// margin of at most 5 mm. Its targets may be moved meanwhile (plan_targets.hpp): from then on it
/// plans for the new ones, and is judged by how far it came towards them.

#include <algorithm>
#include <optional>
#include <string_view>

#include "softgauss/io/plan_task.hpp"
#include "softgauss/io/simulation/plan_targets.hpp"
#include "softgauss/io/simulation/scene.hpp"

namespace softgauss {

/// There is no plan that the actuators can cause. what() says what is left, and what to try.
class PlanError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a motion has cost.
struct MotionCost {
  double running = 0.0;  ///< of states, up to now
  double effort = 0.0;
  double final = 0.0;  ///< at the plan's end, or now where it has not come or recedes
  double total() const { return running + effort + final; }
};

class PlanControl {
 public:
  /// The scene must outlive this. Throws ModelError where plans cannot have what it has.
  PlanControl(const Scene& scene, io::PlanTask task, bool receding);
  PlanControl(const PlanControl&) = delete;

  /// Plans from the scene's start. Throws PlanError.
  const planning::MotionPlan& solve() { return solve(scene_.initial); }
  /// Gives the controller the goal, the price of control, bounds and targets of the plan. What its
  /// goals were is no more, nor are velocity limits, which plans do not know.
  void attach(gdd::GoalDirectedController& controller);
  /// The plan begins now.
  void begin(const State& state);
  /// The state is another than the motion led to: plans from there and begins anew. Throws
  /// PlanError; then nothing is asked for until the next call.
  void restart(const State& state);
  /// Before a step from `state`: plans anew where it is time, and sets the goal.
  void update(const State& state);
  /// A step by this control (nv) was taken.
  void addStep(const VectorX& control, double seconds);

  /// Up to `state`.
  MotionCost cost(const State& state);
  /// What a second costs at a state that the motion is in, q and v, under this control: the running
  /// terms and the effort.
  MotionCost rate(const VectorX& q, const VectorX& v, const VectorX& control);
  /// The same of the first plan, until it has ended.
  std::optional<MotionCost> plannedRate(double time);
  /// What the final terms cost where the plan began, or a target was moved last, and where the plan
  /// is to end.
  double finalAtStart() const { return finalAtStart_; }
  double finalPlanned() const { return finalPlanned_; }
  double planned() const { return plan_.cost; }  ///< cost of the first plan
  /// Whether a motion that ends with these final terms has lost the plan: more than a tenth of what
  /// they were to fall by is missing.
  bool isLost(double final) const {
    constexpr double kShare = 0.1;
    return !(final <= finalAimed_ + kShare * std::max(finalAtStart_ - finalAimed_, 0.0));
  }
  /// Whether such a motion is hardly nearer to the target than where the plan began, though that
  /// was away from it.
  bool isNoNearer(double final) const {
    constexpr double kShare = 0.9, kAway = 0.01;
    return finalAtStart_ > kAway * plan_.cost && final > kShare * finalAtStart_;
  }
  /// What somebody would say who watched, of a motion that has come to `state`: carried out, lost,
  /// lost after its end, no nearer, cut short.
  std::string_view outcome(const State& state);
  /// What the final terms cost there.
  double finalCost(const State& state);
  /// How far `state` is from the plan's end, or a receding one's target: the degree of freedom that
  /// is farthest, and by how much [m, rad].
  std::pair<int, double> farthest(const State& state) const;
  bool hasEnded(double time) const { return time >= begun_ + duration() - kRounding; }
  double duration() const { return task_.steps.knots * task_.steps.step; }  ///< of the plan [s]

  bool recedes() const { return recedes_; }
  const io::PlanTask& task() const { return task_; }
  planning::Planner& planner() { return planner_; }
  const planning::Planner& planner() const { return planner_; }
  const planning::HorizonReport& report() const { return horizon_.report(); }

 private:
  static constexpr double kRounding = 1e-9;  // [s]
  const planning::MotionPlan& solve(const State& start);
  void setCosts();
  void takeTargets(const State& state);
  double sumOf(const std::vector<std::unique_ptr<planning::CostTerm>>& terms, const State& state,
               int knot);
  MotionCost rateAt(int knot, const VectorX& q, const VectorX& v, const VectorX& control);

  const Scene& scene_;
  io::PlanTask task_;
  bool recedes_;
  collision::PreparedMeshes meshes_;
  planning::Planner planner_;
  planning::RecedingHorizon horizon_;
  planning::MotionPlan plan_;  ///< the first, or that of the last restart
  PlanTargets targets_;
  Kinematics kinematics_;
  State seen_;  ///< of rateAt()
  MotionCost cost_;
  std::optional<State> end_;  ///< where the plan has ended
  int counted_ = 0;           ///< knots
  double due_ = 0.0;          ///< their cost that no step has followed yet
  double begun_ = 0.0;        ///< [s]
  double finalAtStart_ = 0.0, finalPlanned_ = 0.0;
  double finalAimed_ = 0.0;  ///< as planned; 0 once a target has moved
};

}  // namespace softgauss

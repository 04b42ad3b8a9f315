// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/plan_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace softgauss {
namespace {

using planning::PlanStatus;

/// Planning contacts of a receding plan are near enough to those of the scene.
io::PlanTask made(io::PlanTask task, bool recedes) {
  constexpr double kMargin = 0.005;  // [m]
  if (recedes && task.contacts && !task.recedesOnOwnContacts) {
    task.endsOnOwnContacts = false;
    task.contacts->contacts.margin = std::min(task.contacts->contacts.margin, kMargin);
  }
  return task;
}

const Scene& checked(const Scene& scene) {
  if (!scene.actuators.empty())
    throw ModelError(scene.actuators[0].where, "key 'plan'",
                     fmt::format("the scene has the actuator '{}', and plans know the motors of "
                                 "joints alone; expected none",
                                 scene.actuators[0].name));
  if (scene.throughFcl)
    throw ModelError(scene.collisionWhere, "key 'plan'",
                     "plans touch by the own collision detection, expected no fcl");
  if (scene.model.options.sleep.enabled)
    throw ModelError({scene.file.string(), 0}, "key 'plan'",
                     "a plan is of the whole scene, found the option sleep, expected none");
  return scene;
}

}  // namespace

PlanControl::PlanControl(const Scene& scene, io::PlanTask task, bool receding)
    : scene_(checked(scene)),
      task_(made(std::move(task), receding)),
      recedes_(receding),
      meshes_(scene.contacts->meshes()),
      planner_(scene.model, task_.steps,
               [this](const Model& model) {
                 return std::make_unique<collision::SceneContacts>(
                     model, collision::SceneContacts::kBroadphasePairs, true, &meshes_);
               }),
      horizon_(planner_, receding ? task_.mpc : planning::HorizonOptions{}),
      kinematics_(scene.model),
      seen_(scene.model) {
  task_.setCosts(planner_);
}

const planning::MotionPlan& PlanControl::solve(const State& start) {
  const planning::MotionPlan& plan = task_.solve(planner_, start);
  if (plan.status == PlanStatus::refused)
    throw PlanError(fmt::format(
        "no plan was found: {} is not finite; try a shorter plan.step, smaller weights or a start "
        "without overlaps",
        plan.refusedKnot < 0 ? "its start or the motion from rest"
                             : fmt::format("a force or a cost at knot {}, {:.4g} s on,",
                                           plan.refusedKnot, plan.refusedKnot * task_.steps.step)));
  if (plan.status == PlanStatus::infeasible)
    throw PlanError(fmt::format(
        "no plan was found that the actuators can cause: after {} iterations forces of {:.3g} N or "
        "N m are left that nobody causes; try more plan.iterations.infeasible, gentler "
        "plan.contacts, a longer plan or a smaller plan.effort",
        plan.iterations, plan.rootForce));
  return plan_ = plan;
}

void PlanControl::attach(gdd::GoalDirectedController& controller) {
  controller.goals.clear();
  controller.motionLimits.reset();
  horizon_.attach(controller);
  targets_.join(scene_.model, task_, !recedes_, controller.goals);
}

void PlanControl::begin(const State& state) {
  cost_ = {};
  end_.reset();
  counted_ = 0, due_ = 0.0;
  begun_ = state.time;
  if (!horizon_.begin(state))
    throw PlanError("the plan has no value model, for some control of it has no least cost");
  finalAtStart_ = finalCost(state);
  State end(scene_.model);
  end.q = plan_.q.back(), end.v = plan_.v.back();
  finalPlanned_ = finalAimed_ = finalCost(end);
}

void PlanControl::restart(const State& state) {
  horizon_.end();
  begun_ = state.time;
  if (targets_.update(state.time, task_)) setCosts();
  planner_.cost.passed = 0;
  solve(state);
  begin(state);
}

void PlanControl::setCosts() {
  planner_.cost.running.clear();
  planner_.cost.final.clear();
  task_.setCosts(planner_);
}

/// A run whose target has moved is to come to the new one from where it is.
void PlanControl::takeTargets(const State& state) {
  if (!targets_.update(state.time, task_)) return;
  setCosts();
  horizon_.takeCosts();
  finalAtStart_ = finalCost(state);
  finalAimed_ = 0.0;
}

void PlanControl::update(const State& state) {
  takeTargets(state);
  const double h = task_.steps.step;
  const auto isDue = [&] { return state.time >= begun_ + h * double(counted_) - kRounding; };
  for (; isDue() && (recedes_ || counted_ < task_.steps.knots); ++counted_)
    due_ += h * sumOf(planner_.cost.running, state, counted_);
  if (!recedes_ && !end_ && hasEnded(state.time)) end_ = state;
  horizon_.update(state);
}

void PlanControl::addStep(const VectorX& control, double seconds) {
  cost_.running += due_;
  due_ = 0.0;
  if (!end_) cost_.effort += 0.5 * seconds * task_.effort.dot(control.cwiseAbs2());
}

MotionCost PlanControl::rateAt(int knot, const VectorX& q, const VectorX& v,
                               const VectorX& control) {
  seen_.q = q, seen_.v = v;
  return {sumOf(planner_.cost.running, seen_, knot), 0.5 * task_.effort.dot(control.cwiseAbs2()),
          0.0};
}

MotionCost PlanControl::rate(const VectorX& q, const VectorX& v, const VectorX& control) {
  return rateAt(std::max(0, counted_ - 1), q, v, control);
}

std::optional<MotionCost> PlanControl::plannedRate(double time) {
  if (hasEnded(time) || !horizon_.acts()) return std::nullopt;
  const auto t = static_cast<std::size_t>((time - begun_ + kRounding) / task_.steps.step);
  return rateAt(static_cast<int>(t), plan_.q[t], plan_.v[t], plan_.tau[t]);
}

double PlanControl::sumOf(const std::vector<std::unique_ptr<planning::CostTerm>>& terms,
                          const State& state, int knot) {
  computeKinematics(scene_.model, state, kinematics_);
  double sum = 0.0;
  for (const auto& term : terms)
    sum += term->value({scene_.model, state.q, state.v, knot, &kinematics_});
  return sum;
}

double PlanControl::finalCost(const State& state) {
  return sumOf(planner_.cost.final, state, task_.steps.knots);
}

MotionCost PlanControl::cost(const State& state) {
  MotionCost cost = cost_;
  cost.final = finalCost(end_ ? *end_ : state);
  return cost;
}

std::string_view PlanControl::outcome(const State& state) {
  if (!recedes_ && !hasEnded(state.time)) return "cut short";
  const double final = cost(state).final;
  if (isLost(final)) return "lost";
  if (!recedes_ && isLost(finalCost(state))) return "lost after its end";
  return isNoNearer(final) ? "no nearer" : "carried out";
}

std::pair<int, double> PlanControl::farthest(const State& state) const {
  const VectorX& aim = recedes_ ? task_.q.back() : plan_.q.back();
  const VectorX off = positionDifference(scene_.model, aim, (end_ ? *end_ : state).q);
  Eigen::Index dof = 0;
  const double most = off.cwiseAbs().maxCoeff(&dof);
  return {static_cast<int>(dof), most};
}

}  // namespace softgauss

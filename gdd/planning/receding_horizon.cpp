// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/receding_horizon.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace softgauss::planning {

RecedingHorizon::RecedingHorizon(Planner& planner, const HorizonOptions& options)
    : planner_(planner),
      options_(options),
      start_(planner.feasible().trajectory().knots[0]),
      along_(VectorX::Zero(planner.model().nv)) {
  const double h = planner.model().options.timestep;
  if (!(options.period >= 0.0 && options.period <= h))
    throw ModelError({}, "receding horizon",
                     "period is " + std::to_string(options.period) +
                         " s, expected from 0 to the plan's step, " + std::to_string(h) + " s");
  if (options.iterations < 0 || !(options.seconds > 0.0))
    throw ModelError({}, "receding horizon", "expected iterations ≥ 0 and seconds > 0");
}

void RecedingHorizon::attach(gdd::GoalDirectedController& controller) {
  const Model& model = planner_.model();
  auto goal = std::make_unique<gdd::QuadraticValue>(model);
  goal->timestep = model.options.timestep;
  goal->freeControl = VectorX::Zero(model.nv);
  goal_ = goal.get();
  controller.goals.push_back(std::move(goal));
  controller.controlCost = gdd::ControlCost::total;
  VectorX price = VectorX::Ones(model.nv);
  for (int i = 0; i < model.nv; ++i)
    if (model.dofs[idx(i)].actuated) price[i] = model.options.timestep * planner_.cost.effort[i];
  controller.forceMetric = gdd::ForceMetric::diagonal(price);
}

bool RecedingHorizon::begin(const State& state) {
  report_ = {};
  if (!planner_.refresh()) return false;
  begun_ = state.time;
  due_ = options_.period > 0.0 ? begun_ + options_.period : kInfinity;
  report_.cost = planner_.feasible().trajectory().cost;
  return true;
}

void RecedingHorizon::update(const State& state) {
  constexpr double kRounding = 1e-9;
  if (state.time >= due_ - kRounding) {
    tick(state);
    due_ += options_.period;
  }
  setGoal(state.time);
}

void RecedingHorizon::tick(const State& state) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto taken = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  ++report_.ticks;
  start_.q = state.q, start_.v = state.v;
  start_.hasLast = state.hasAcceleration && state.a.size() == start_.last.size();
  if (start_.hasLast) start_.last = state.a;
  const double passed = (state.time - begun_) / planner_.model().options.timestep;
  if (planner_.moveOn(std::min(passed, 1.0), start_)) {
    begun_ = state.time;
    for (int i = 0; i < options_.iterations && taken() < options_.seconds; ++i) planner_.improve();
    if (!planner_.refresh()) ++report_.failed;
    report_.cost = planner_.feasible().trajectory().cost;
  } else {
    ++report_.failed;
  }
  report_.seconds += taken();
  report_.longest = std::max(report_.longest, taken());
}

void RecedingHorizon::setGoal(double time) {
  if (!goal_) return;
  const Model& model = planner_.model();
  const FeasiblePhase& plan = planner_.feasible();
  const std::vector<Knot>& knots = plan.trajectory().knots;
  const auto last = static_cast<double>(knots.size() - 1);
  const double at = std::clamp((time - begun_) / model.options.timestep, 0.0, last);
  const double whole = std::floor(at), share = at - whole;
  const auto index = [&](double knot) { return static_cast<std::size_t>(std::min(knot, last)); };
  const auto between = [share](auto& to, const auto& from, const auto& next) {
    to = (1.0 - share) * from + share * next;
  };
  const std::size_t from = index(whole + 1.0), next = index(whole + 2.0);
  goal_->q = knots[from].q;
  positionDifference(model, knots[from].q, knots[next].q, along_);
  integratePosition(model, along_, share, goal_->q);
  between(goal_->v, knots[from].v, knots[next].v);
  between(goal_->slope, plan.values()[from].slope, plan.values()[next].slope);
  between(goal_->curvature, plan.values()[from].curvature, plan.values()[next].curvature);
  const auto move = [&](double knot) { return std::min(index(knot), knots.size() - 2); };
  between(goal_->about, knots[move(whole)].a, knots[move(whole + 1.0)].a);
}

}  // namespace softgauss::planning

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/receding_horizon.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace softgauss::planning {
namespace {

constexpr double kRounding = 1e-6;  // of a step of the plan: that near a knot is there
constexpr int kMostLost = 3;        // ticks

/// The plan's model, in the steps in which it is acted out.
Model actedOut(const Planner& planner) {
  Model model = planner.model();
  model.options = planner.acting();
  return model;
}

}  // namespace

RecedingHorizon::Prediction::Prediction(const Planner& planner)
    : model(actedOut(planner)),
      contacts(planner.contactsFor(model)),
      data(model),
      controller(model),
      goal(nullptr),
      state(model) {}

RecedingHorizon::RecedingHorizon(Planner& planner, const HorizonOptions& options)
    : planner_(planner), options_(options), start_(planner.feasible().trajectory().knots[0]) {
  const double h = planner.model().options.timestep;
  if (!(options.period >= 0.0 && options.period <= h))
    throw ModelError({}, "receding horizon",
                     "period is " + std::to_string(options.period) +
                         " s, expected from 0 to the plan's step, " + std::to_string(h) + " s");
  if (options.iterations < 0 || !(options.seconds > 0.0))
    throw ModelError({}, "receding horizon", "expected iterations ≥ 0 and seconds > 0");
}

gdd::QuadraticValue* RecedingHorizon::addGoal(gdd::GoalDirectedController& controller) const {
  const Model& model = planner_.model();
  auto goal = std::make_unique<gdd::QuadraticValue>(model);
  goal->timestep = model.options.timestep;
  goal->freeControl = VectorX::Zero(model.nv);
  gdd::QuadraticValue* const added = goal.get();
  controller.goals.push_back(std::move(goal));
  controller.controlCost = gdd::ControlCost::total;
  VectorX price = VectorX::Ones(model.nv);
  for (int i = 0; i < model.nv; ++i)
    if (model.dofs[idx(i)].actuated) price[i] = model.options.timestep * planner_.cost.effort[i];
  controller.forceMetric = gdd::ForceMetric::diagonal(price);
  return added;
}

void RecedingHorizon::attach(gdd::GoalDirectedController& controller) {
  goal_ = addGoal(controller);
}

bool RecedingHorizon::begin(const State& state) {
  report_ = {};
  planner_.cost.passed = first_ = lostInARow_ = 0;
  costsChanged_ = false;
  planner_.cost.keepsEnd = options_.keepsEnd;
  if (!planner_.refresh()) return false;
  begun_ = state.time;
  due_ = kInfinity;
  if (options_.period > 0.0) {
    due_ = begun_ + options_.period;
    prediction_ = std::make_unique<Prediction>(planner_);
    prediction_->goal = addGoal(prediction_->controller);
  }
  report_.cost = planner_.feasible().trajectory().cost;
  acts_ = true;
  if (goal_) goal_->startTime = -kInfinity;
  return true;
}

void RecedingHorizon::end() {
  acts_ = false;
  if (goal_) goal_->startTime = kInfinity;
}

double RecedingHorizon::knotAt(double time) const {
  return (time - begun_) / planner_.model().options.timestep;
}

void RecedingHorizon::update(const State& state) {
  if (!acts_) return;
  if (state.time >= due_ - kRounding * options_.period) {
    tick(state);
    while (due_ <= state.time + kRounding * options_.period) due_ += options_.period;
  }
  if (goal_) setGoal(state.time, *goal_);
}

/// The state at the next knot, or at that which is now, as the plan's start: by the steps in which
/// it is acted out.
bool RecedingHorizon::predict(const State& state) {
  Prediction& p = *prediction_;
  p.state.q = state.q, p.state.v = state.v, p.state.time = state.time;
  p.state.forgetLastStep();
  p.state.a = state.a, p.state.hasAcceleration = state.hasAcceleration;
  const double at = knotAt(state.time);
  const double left = (std::ceil(at - kRounding) - at) * planner_.model().options.timestep;
  const int steps = static_cast<int>(std::ceil(left / planner_.acting().timestep - kRounding));
  if (steps > 0) p.model.options.timestep = left / steps;
  for (int i = 0; i < steps; ++i) {
    setGoal(p.state.time, *p.goal);
    if (isRefused(p.controller.step(p.model, {}, p.state, p.data, p.contacts.get()))) return false;
  }
  start_.q = p.state.q, start_.v = p.state.v;
  start_.hasLast = p.state.hasAcceleration && p.state.a.size() == start_.last.size();
  if (start_.hasLast) start_.last = p.state.a;
  return true;
}

void RecedingHorizon::tick(const State& state) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto taken = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  ++report_.ticks;
  if (std::exchange(costsChanged_, false)) planner_.takeCosts();
  const int next = static_cast<int>(std::ceil(knotAt(state.time) - kRounding));
  planner_.cost.passed = next;
  const bool moved =
      predict(state) && planner_.moveOn(next - first_, start_, lostInARow_ >= kMostLost);
  lostInARow_ = moved ? 0 : lostInARow_ + 1;
  if (moved) {
    first_ = next;
    for (int i = 0; i < options_.iterations && taken() < options_.seconds; ++i) planner_.improve();
    if (!planner_.refresh()) ++report_.failed;
    report_.cost = planner_.feasible().trajectory().cost;
  } else {
    ++report_.failed;
    planner_.cost.passed = first_;
  }
  report_.last = taken();
  report_.seconds += report_.last;
  report_.longest = std::max(report_.longest, report_.last);
}

/// Beyond the plan's end its last model is the goal, a step of the plan on. R stays as it is, and V
/// is over r/h in its place.
void RecedingHorizon::setGoal(double time, gdd::QuadraticValue& goal) const {
  const FeasiblePhase& plan = planner_.feasible();
  const std::vector<Knot>& knots = plan.trajectory().knots;
  const auto last = static_cast<double>(knots.size() - 1);
  const double at = knotAt(time) - first_;
  const double next = std::min(std::floor(at + kRounding) + 1.0, last);
  const double left = at < last - kRounding ? next - at : 1.0;
  const auto knot = static_cast<std::size_t>(std::max(next, 0.0));
  goal.timestep = left * planner_.model().options.timestep;
  goal.q = knots[knot].q, goal.v = knots[knot].v;
  goal.slope = plan.values()[knot].slope / left;
  goal.curvature = plan.values()[knot].curvature / left;
  goal.about = knots[knot > 0 ? knot - 1 : 0].a;
}

}  // namespace softgauss::planning

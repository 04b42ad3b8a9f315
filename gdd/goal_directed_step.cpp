// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goal_directed_step.hpp"

#include <chrono>
#include <tuple>

#include "softgauss/gdd/goals/standing_balance.hpp"

namespace softgauss::gdd {

GoalDirectedController::GoalDirectedController(const Model& model)
    : limits(model),
      augmentedLagrangian(model),
      activeSet(model),
      expansion(model),
      control(VectorX::Zero(model.nv)),
      cost_(model.nv),
      holding_(model),
      coordinates_(VectorX::Zero(model.nv)) {}

namespace {

/// A warm start that the solver cannot begin from: it begins without.
bool refuses(const ActiveSet&, const WarmStart& warm) {
  return warm.gddValid && !(warm.gddA.allFinite() && warm.control.allFinite());
}
bool refuses(const AugmentedLagrangian&, const WarmStart& warm) {
  return warm.gddValid && !(warm.gddA.allFinite() && warm.multipliers.allFinite());
}

/// What is left of the equation of motion where the solver has ended on it, or null.
const VectorX* exactResidual(const ActiveSet& solver) {
  return solver.isExact() ? &solver.residual() : nullptr;
}
const VectorX* exactResidual(const AugmentedLagrangian&) { return nullptr; }

}  // namespace

void GoalDirectedController::addCost(const Model& model, const State& state, Data& data,
                                     GravityCompensation& holding, GoalCost& cost) const {
  cost.clear(forceMetric);
  if (controlCost == ControlCost::aboutGravity && limits.firstBad(model.nv) < 0)
    cost.setFreeControl(holding.compute(model, state, limits, data));
  for (const auto& goal : goals)
    if (goal->actsAt(state.time)) addCostAmong(goals, *goal, {model, state, data}, cost);
  if (motionLimits) motionLimits->addCost({model, state, data}, limits, cost);
}

template <class Solver>
const VectorX* GoalDirectedController::solve(Solver& used, const Model& model, const State& state,
                                             Data& data) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  solved_ = false;
  // A disturbance is not the control's: it belongs to what the control has to cope with.
  data.forces.c -= data.forces.tau;
  addCost(model, state, data, holding_, cost_);
  data.stats.invalidWarmStarts += refuses(used, state.warmstart);
  expansion.iterationsLeft = iterationBudget;
  expansion.deadline = Deadline::in(timeBudget);
  report = solveOneSided(expansion, used, model, cost_, limits, data, state.warmstart, between_);
  if (const VectorX* residual = exactResidual(used); residual && !cost_.hasFunctions()) {
    solved_ = true;
    data.forward.gradient = -*residual;
  }
  const GddReport solved = report;
  report.addEarlier(earlier_);
  earlier_.addCounts(solved);
  solveTime += std::chrono::duration<double>(Clock::now() - start).count();
  if (isRefused(report.status)) {
    if (report.status == GddStatus::badLimits) {
      data.stats.refuse(model, limits.badInput(model.nv));
      return nullptr;
    }
    data.stats.status = SolveStatus::notFinite;
    data.stats.badDof = used.badDof();
    return nullptr;
  }

  limits.clamp(expansion.force(), control, coordinates_);
  limits.commands(coordinates_, commands);
  setAppliedForce(control, data.forces);
  if (data.stages)  // an integrator that looks at the dynamics again
    held_.tau = outside_.size() == model.nv ? VectorX(outside_ + control) : control;
  return &expansion.acceleration();
}

const VectorX* GoalDirectedController::apply(const Model& model, const State& state,
                                             Data& data) noexcept {
  if (solver == GddSolver::activeSet && data.constraints.piecewiseQuadratic())
    return solve(activeSet, model, state, data);
  return solve(augmentedLagrangian, model, state, data);
}

void GoalDirectedController::reserve(const Model& model, const State& state, Data& data) {
  const int rows = data.constraints.rowCount();
  std::vector<std::pair<double, double>> times;
  for (const auto& goal : goals) {  // all at once
    times.emplace_back(goal->startTime, goal->endTime);
    goal->startTime = -kInfinity, goal->endTime = kInfinity;
  }
  begin();
  apply(model, state, data);
  for (std::size_t i = 0; i < goals.size(); ++i)
    std::tie(goals[i]->startTime, goals[i]->endTime) = times[i];
  const auto controls = (limits.lower.array() < limits.upper.array()).count();
  cost_.reserve(static_cast<int>(controls), static_cast<int>(data.contacts.contacts.capacity()));
  if (solver == GddSolver::activeSet && data.constraints.piecewiseQuadratic())
    activeSet.reserve(rows);
  expansion.reserve(rows);
  expansion.keepWarmStart(between_);
  between_.breakpoints.reserve(static_cast<std::size_t>(rows));
  held_.wrenches.reserve(model.bodies.size());
  held_.controlled.reserve(model.trees.size());
  begin();
  report = {};
}

void GoalDirectedController::begin() noexcept {
  solveTime = 0.0;
  earlier_ = {};
}

void GoalDirectedController::keep(WarmStart& warmstart) noexcept {
  expansion.keepWarmStart(warmstart);
  earlier_ = report;
}

void GoalDirectedController::takeSettings(const GoalDirectedController& from) {
  motionLimits = from.motionLimits;
  controlCost = from.controlCost;
  solver = from.solver;
  augmentedLagrangian.options = from.augmentedLagrangian.options;
  activeSet.options = from.activeSet.options;
  expansion.tolerance = from.expansion.tolerance;
  expansion.maxSolves = from.expansion.maxSolves;
  iterationBudget = from.iterationBudget;
  timeBudget = from.timeBudget;
}

SolveStatus GoalDirectedController::step(const Model& model, const Input& input, State& state,
                                         Data& data, ContactSource* contacts, bool posed) noexcept {
  if (data.stats.refuse(model, findBadInput(model, input, state))) return data.stats.status;
  held_ = input;
  markControlled(model, held_.controlled);
  outside_ = input.tau;
  begin();
  return softgauss::step(model, held_, state, data, contacts, this, posed);
}

}  // namespace softgauss::gdd

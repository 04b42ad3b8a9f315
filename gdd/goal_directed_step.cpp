// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goal_directed_step.hpp"

#include <algorithm>
#include <chrono>
#include <tuple>
#include <type_traits>

#include "softgauss/gdd/goals/standing_balance.hpp"

namespace softgauss::gdd {

GoalDirectedController::GoalDirectedController(const Model& model)
    : limits(model),
      augmentedLagrangian(model),
      activeSet(model),
      expansion(model),
      control(VectorX::Zero(model.nv)),
      islands_(model),
      solution_(model),
      cost_(model.nv),
      holding_(model),
      coordinates_(VectorX::Zero(model.nv)) {}

namespace {

/// A warm start that the solver cannot begin from: it begins without.
bool refuses(const ActiveSet&, const WarmStart& warm, Segments dofs) {
  return warm.gddValid && !(allFinite(dofs, warm.gddA) && allFinite(dofs, warm.control));
}
bool refuses(const AugmentedLagrangian&, const WarmStart& warm, Segments dofs) {
  return warm.gddValid && !(allFinite(dofs, warm.gddA) && allFinite(dofs, warm.multipliers));
}

/// What the islands of one control may take together: each gets its share of what the ones before
/// have left.
class Budget {
 public:
  Budget(int iterations, double seconds) : iterations_(iterations), seconds_(seconds) {
    if (seconds_ < kInfinity) start_ = Clock::now();
  }
  /// Of so many islands that are left.
  void share(int islands, SequentialQuadraticSolve& solve) const {
    solve.iterationsLeft = islands > 1 ? std::max(iterations_ / islands, 1) : iterations_;
    solve.deadline = {};
    if (seconds_ == kInfinity) return;
    const double spent = std::chrono::duration<double>(Clock::now() - start_).count();
    solve.deadline = Deadline::in((seconds_ - spent) / islands);
  }
  void spend(int iterations) { iterations_ = std::max(0, iterations_ - iterations); }

 private:
  using Clock = std::chrono::steady_clock;
  int iterations_;
  double seconds_;
  Clock::time_point start_;
};

/// What is left of the equation of motion where the solver has ended on it, or null.
const VectorX* exactResidual(const ActiveSet& solver) {
  return solver.isExact() ? &solver.residual() : nullptr;
}
const VectorX* exactResidual(const AugmentedLagrangian&) { return nullptr; }

}  // namespace

void GoalDirectedController::addGoals(const Model& model, const State& state, const Data& data,
                                      GoalCost& cost) const {
  // Of who sleeps nothing is asked.
  const auto isAsked = [&](const Goal& goal) {
    return goal.actsAt(state.time) &&
           (!data.active.anyStill() || std::ranges::any_of(data.active.trees(), [&](int tree) {
             return goal.concerns(model, tree);
           }));
  };
  for (const auto& goal : goals)
    if (isAsked(*goal)) addCostAmong(goals, *goal, {model, state, data}, cost);
  if (motionLimits) motionLimits->addCost({model, state, data}, limits, cost);
}

void GoalDirectedController::addCost(const Model& model, const State& state, Data& data,
                                     GravityCompensation& holding, GoalCost& cost) const {
  cost.clear(forceMetric);
  if (controlCost == ControlCost::aboutGravity && limits.firstBad(model.nv) < 0)
    cost.setFreeControl(holding.compute(model, state, limits, data));
  addGoals(model, state, data, cost);
}

ActiveSet& GoalDirectedController::solverOf(ActiveSet& first, const Model& model, int controls) {
  if (islands_.isWhole() || controls_ < 0) controls_ = controls;
  if (controls == controls_) return first;
  ActiveSet& other = others_.try_emplace(controls, model).first->second;
  other.options = first.options;
  return other;
}

/// Each island on which a control acts, or the one that there is. False where one has no solution.
template <class Solver>
bool GoalDirectedController::solveIslands(Solver& used, const Model& model, const State& state,
                                          Data& data) {
  const bool together = std::is_same_v<Solver, AugmentedLagrangian>;
  if (!islands_.find(model, limits, together, cost_, data)) return false;
  islands_.addColumns(model, data);
  // A goal may have set it: the value of a plan does.
  const bool holds = controlCost == ControlCost::aboutGravity && !cost_.controlCost().hasFree();
  solution_.begin(model, state, limits, islands_, data);
  Budget budget(iterationBudget, timeBudget);
  int left = 0;
  for (int i = 0; i < islands_.size(); ++i) left += islands_.isSolved(i) && !solution_.keeps(i);
  bool solved = true;
  for (int i = 0; i < islands_.size() && solved; ++i) {
    if (!islands_.isSolved(i)) continue;
    islands_.select(model, i, cost_, data);
    if (solution_.keeps(i)) {
      report.add(solution_.keep(i, data));
      continue;
    }
    if (holds) cost_.setFreeControl(holding_.compute(model, state, limits, data));
    budget.share(left--, expansion);
    Solver& own = solverOf(used, model, islands_.controls(i));
    const GddReport found =
        solveOneSided(expansion, own, model, cost_, limits, data, state.warmstart, between_);
    budget.spend(found.iterations);
    report.add(found);
    solved = !isRefused(found.status);
    const VectorX* residual = cost_.hasFunctions() ? nullptr : exactResidual(own);
    if (solved)
      solution_.take(model, i, expansion, residual, found, data);
    else
      data.stats.badDof = own.badDof();
  }
  islands_.selectAll(model, cost_, data);
  return solved;
}

template <class Solver>
const VectorX* GoalDirectedController::solve(Solver& used, const Model& model, const State& state,
                                             Data& data) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = data.timed ? Clock::now() : Clock::time_point();
  report = {};
  if (const BadInput bad = limits.badInput(model.nv, data.active.dofs())) {
    report.status = GddStatus::badLimits;
    data.stats.refuse(model, bad);
    return nullptr;
  }
  // A disturbance is not the control's: it belongs to what the control has to cope with.
  for (const Segment s : data.active.dofs()) part(data.forces.c, s) -= part(data.forces.tau, s);
  cost_.clear(forceMetric, data.active.dofs());
  addGoals(model, state, data, cost_);
  data.stats.invalidWarmStarts += refuses(used, state.warmstart, data.active.dofs());
  const bool solved = solveIslands(used, model, state, data);
  const GddReport own = report;
  report.addEarlier(earlier_);
  earlier_.addCounts(own);
  if (data.timed) solveTime += std::chrono::duration<double>(Clock::now() - start).count();
  if (!solved) {
    data.stats.status = SolveStatus::notFinite;
    return nullptr;
  }

  setControl(data);
  setAppliedForce(data.active.dofs(), control, data.forces);
  if (data.stages)  // an integrator that looks at the dynamics again
    held_.tau = outside_.size() == model.nv ? VectorX(outside_ + control) : control;
  return &solution_.a;
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
  if (model.trees.size() > 1) {  // and where nothing touches: islands of fewer controls
    computeStages(model, {}, state, data, nullptr);
    apply(model, state, data);
  }
  for (std::size_t i = 0; i < goals.size(); ++i)
    std::tie(goals[i]->startTime, goals[i]->endTime) = times[i];
  const auto controls = (limits.lower.array() < limits.upper.array()).count();
  cost_.reserve(static_cast<int>(controls), static_cast<int>(data.contacts.contacts.capacity()));
  const bool any = std::ranges::find(solution_.controlled, 1) != solution_.controlled.end();
  if (any && solver == GddSolver::activeSet && data.constraints.piecewiseQuadratic()) {
    activeSet.reserve(rows);
    for (auto& [count, other] : others_) other.reserve(rows);
  }
  expansion.reserve(rows);
  expansion.keepWarmStart(between_);
  between_.breakpoints.reserve(static_cast<std::size_t>(rows));
  solution_.reserve(rows);
  held_.wrenches.reserve(model.bodies.size());
  held_.controlled.reserve(model.trees.size());
  begin();
  report = {};
}

void GoalDirectedController::begin() noexcept {
  solveTime = 0.0;
  earlier_ = {};
}

void GoalDirectedController::keep(WarmStart& warmstart, const TreeSelection& trees) noexcept {
  copySolution(solution_.warm, trees, warmstart);
  earlier_ = report;
}

/// Who sleeps keeps its own.
void GoalDirectedController::setControl(const Data& data) {
  if (data.active.all()) {
    limits.clamp(solution_.force, control, coordinates_);
  } else {
    limits.clamp(data.active.dofs(), solution_.force, control, coordinates_);
  }
  limits.commands(coordinates_, commands);
}

namespace {

/// Whether a goal acts at a time, 1, and asks for motion, 2.
int acting(const Goal& goal, double time) {
  return !goal.actsAt(time) ? 0 : goal.restsAt(time) ? 1 : 2;
}

}  // namespace

/// It does not act on the tree; or else may let it rest, and what it wants stays where it is. Where
/// all is one problem, nobody may be left out.
bool GoalDirectedController::letsSleep(const Model& model, int tree, double time) const noexcept {
  if (islands_.isOneProblem()) return false;
  if (solution_.controlled[idx(tree)] == 0) return true;
  return model.options.sleep.controlled && std::ranges::none_of(goals, [&](const auto& goal) {
           return acting(*goal, time) == 2 && goal->concerns(model, tree);
         });
}

bool GoalDirectedController::markChanged(const Model& model, double before, double now,
                                         std::span<std::uint8_t> trees) noexcept {
  bool any = false;
  for (const auto& goal : goals) {
    if (acting(*goal, now) == acting(*goal, before)) continue;
    for (std::size_t t = 0; t < trees.size(); ++t)
      if (goal->concerns(model, static_cast<int>(t))) trees[t] = 1, any = true;
  }
  return any;
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
                                         Data& data, ContactSource* contacts) noexcept {
  if (data.stats.refuse(model, findBadInput(model, input))) return data.stats.status;
  held_ = input;
  markControlled(model, held_.controlled);
  outside_ = input.tau;
  begin();
  report = {};
  return softgauss::step(model, held_, state, data, contacts, this);
}

}  // namespace softgauss::gdd

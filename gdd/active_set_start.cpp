// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "softgauss/engine/step/forward.hpp"
#include "softgauss/gdd/active_set.hpp"

/// Where solver 2 starts from, and what it leaves for the next start.

namespace softgauss::gdd {

void ActiveSet::reserve(int crossings) {
  const int controls = cell_.columns();
  cell_.reserve(crossings);
  path_.reserve(crossings, controls);
  program_.reserve(controls, crossings);
  const std::size_t most = idx(crossings);
  constrained_.reserve(most), atBreakpoint_.reserve(most), tried_.reserve(most);
  breakpoints_.reserve(most), first_.breakpoints.reserve(most);
  first_.a.resize(path_.a.size());
  first_.u.resize(controls);
  sides_.resize(crossings, controls);
  distances_.resize(crossings);
}

/// Takes u, within the limits, as the present control and a = f(u). Returns F, ∞ if it is not
/// finite.
double ActiveSet::moveTo(const Model& model, const GoalCost& cost, const VectorX* guess,
                         Data& data) {
  u_ = u_.cwiseMax(lower_).cwiseMin(upper_);
  cell_.force(u_, force_);
  setAppliedForce(dofs_, force_, data.forces);
  if (isRefused(forwardDynamics(model, guess, data))) {
    badDof_ = data.stats.badDof;
    return kInfinity;
  }
  report_.forwardIterations += data.forward.report.iterations;
  if (!ready_ && !setInertia(cost, data)) return kInfinity;
  ready_ = true;
  entered_ = false;
  path_.a = data.forward.a;
  evaluateCost(cost, data);
  computeEffortSlope();
  evaluateForces(data);
  return objective();
}

/// From the last step's a along the exact path to a = f(u), where few rows change their pieces on
/// the way. Returns F, ∞ where it has not come there.
double ActiveSet::moveAlongPath(const GoalCost& cost, const VectorX& a, Data& data) {
  bool changed = false;
  copyOnly(dofs_, a, path_.a);
  data.constraints.setResidual(path_.a);
  data.constraints.evaluate(changed);
  ++report_.factorizations;
  if (!setInertia(cost, data) || !cell_.enter(data)) return kInfinity;
  computeResidual(data);
  cell_.solve(residual_);
  if (!path_.reach(residual_, cell_, data)) return kInfinity;
  ready_ = entered_ = true;
  evaluateCost(cost, data);
  computeEffortSlope();
  evaluateForces(data);
  return objective();
}

/// ℓ and ∇ℓ at a.
void ActiveSet::evaluateCost(const GoalCost& cost, const Data& data) {
  data.inertia.M.multiply(dofs_, path_.a, Ma_);
  cost.gradient(path_.a, Ma_, path_.slope);
  path_.value = cost.value(path_.a, Ma_);
}

/// Contact forces at a, with every row in the piece in which it is kept.
void ActiveSet::evaluateForces(Data& data) {
  if (!forces_.active()) return;
  data.constraints.evaluateInPlace();
  forces_.evaluate(data.constraints);
}

/// The gradient in u of the price of τ = B u + what is given.
void ActiveSet::computeEffortSlope() {
  cell_.multiplyControlCost(u_, effortSlope_);
  effortSlope_ += givenSlope_;
}

/// The price of τ, by its gradient.
double ActiveSet::effort() const {
  return 0.5 * (u_.dot(effortSlope_) + u_.dot(givenSlope_)) + givenEffort_;
}

/// R, and what it makes of forces where the box has no width.
bool ActiveSet::setInertia(const GoalCost& cost, const Data& data) {
  if (!cell_.setInertia(data, cost)) {
    badDof_ = cell_.massFailedRow();
    return false;
  }
  givenEffort_ = 0.0;
  givenSlope_.setZero(cell_.columns());
  const ControlCostTerm& controlCost = cell_.controlCost();
  const bool given = (cell_.given().array() != 0.0).any();
  if (!given && !controlCost.hasFree()) return true;
  rate_.setZero();
  if (given) cell_.multiplyR(cell_.given(), rate_);
  givenEffort_ = controlCost.value(cell_.given(), rate_);
  if (controlCost.hasFree()) rate_ -= controlCost.freeSlope();
  cell_.select(rate_, givenSlope_);
  return true;
}

/// Without a last step: the best of three controls. None; the one that would be best if there were
/// no rows; and the one that makes the acceleration of the latter with the rows there are. Dry
/// friction, say, hides from the first what a larger control would gain.
void ActiveSet::chooseStart(const Model& model, const GoalCost& cost, Data& data) {
  u_.setZero();
  best_ = u_;
  double least = moveTo(model, cost, nullptr, data);
  const auto consider = [&] {
    const double value = moveTo(model, cost, nullptr, data);
    if (value < least) least = value, best_ = u_;
  };
  if (data.constraints.rowCount() > 0 && u_.size() > 0 && std::isfinite(least)) {
    const auto moveWithoutRows = [&] {
      cell_.enterWithoutRows();
      path_.a = force_;
      for (const Segment s : dofs_) part(path_.a, s) -= part(data.forces.c, s);
      cell_.solve(path_.a);
    };
    moveWithoutRows();
    evaluateCost(cost, data);
    computeEffortSlope();
    cell_.computeHessian();
    forces_.forget();
    const bool finite = computeGradient(data);
    forces_.setCost(cost.forces());
    if (finite) {
      solveProgram();
      u_ += program_.solution();
      consider();
      moveWithoutRows();
      bool changed = false;
      data.constraints.setResidual(path_.a);
      data.constraints.evaluate(changed);
      computeResidual(data);
      residual_ = force_ - residual_;
      cell_.controls(residual_, u_);
      consider();
    }
    report_.cells = 0;
    entered_ = false;
  }
  u_ = best_;
}

/// u of the last step, within the limits, and a = f(u). Rows that were at breakpoints are kept in
/// their cell at first: most of them stay at their breakpoints.
GddStatus ActiveSet::start(const Model& model, const GoalCost& cost, const ControlLimits& limits,
                           Data& data, const WarmStart& warm) {
  badDof_ = -1;
  ready_ = entered_ = false;
  dofs_ = data.active.dofs();
  const int body = model.dofs[idx(dofs_.front().begin)].body;
  tree_ = idx(model.bodies[idx(body)].tree);
  trees_ = model.trees.size();
  for (VectorX* x : {&force_, &Ma_, &adjoint_, &residual_, &rate_}) x->setZero();
  forces_.setCost(cost.forces());
  tried_.clear();
  path_.held.clear();
  breakpoints_.clear();
  constrained_.clear();
  cell_.setDriven(model, limits, dofs_);
  cell_.pick(limits.lower, lower_);
  cell_.pick(limits.upper, upper_);
  u_.setZero(cell_.columns());
  known_ = warm.gddValid && warm.gddA.allFinite() && warm.control.size() == model.nv &&
           warm.control.allFinite();
  if (known_)
    cell_.pick(warm.control, u_);
  else
    chooseStart(model, cost, data);
  report_.forwardIterations = 0;
  double value = kInfinity;
  if (known_) {
    u_ = u_.cwiseMax(lower_).cwiseMin(upper_);
    cell_.force(u_, force_);
    for (const BreakpointKey& name : warm.breakpoints)
      if (const auto breakpoint = data.constraints.find(name))
        path_.held.entry(*breakpoint).paths = kMaxFreeCrossings;
    value = moveAlongPath(cost, warm.gddA, data);
  }
  if (!std::isfinite(value)) value = moveTo(model, cost, known_ ? &warm.gddA : nullptr, data);
  setAppliedForce(dofs_, force_, data.forces);
  return std::isfinite(value) ? GddStatus::converged : GddStatus::notFinite;
}

void ActiveSet::keepWarmStart(WarmStart& warm) const {
  for (VectorX* x : {&warm.gddA, &warm.control, &warm.multipliers})
    if (x->size() != force_.size()) x->setZero(force_.size());
  copy(dofs_, path_.a, warm.gddA);
  cell_.place(u_, warm.control);
  setZero(dofs_, warm.multipliers);
  warm.breakpoints = breakpoints_;
  warm.gddSearchAge.assign(trees_, 0);
  warm.gddSearchWait.assign(trees_, 1);
  warm.gddSearchAge[tree_] = searchAge_;
  warm.gddSearchWait[tree_] = searchWait_;
  warm.gddValid = true;
}

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/planner.hpp"

#include <chrono>
#include <cmath>

#include "softgauss/engine/step/forward_derivative.hpp"

namespace softgauss::planning {
namespace {

double now() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

std::unique_ptr<Model> planned(const Model& model, const PlanSteps& steps) {
  if (!(steps.step > 0.0 && steps.step < kInfinity))
    throw ModelError({}, "plan", "step is " + std::to_string(steps.step) + " s, expected > 0");
  if (steps.knots < 1)
    throw ModelError({}, "plan", "knots are " + std::to_string(steps.knots) + ", expected ≥ 1");
  auto copy = std::make_unique<Model>(model);
  copy->options = StepDerivative::bareStep(model.options);
  copy->options.noSlip = false;
  copy->options.timestep = steps.step;
  return copy;
}

}  // namespace

std::string_view planStatusName(PlanStatus status) {
  switch (status) {
    case PlanStatus::converged:
      return "converged";
    case PlanStatus::iterationLimit:
      return "iteration limit";
    case PlanStatus::noDescent:
      return "no descent";
    case PlanStatus::infeasible:
      return "infeasible";
    case PlanStatus::refused:
      return "refused";
  }
  return "";
}

Planner::Planner(const Model& model, const PlanSteps& steps, const Contacts& contacts)
    : rootCost(VectorX::Zero(model.nv)),
      model_(planned(model, steps)),
      contacts_(contacts ? contacts(*model_) : nullptr),
      knots_(steps.knots),
      dynamics_(std::make_unique<PlanDynamics>(*model_, contacts_.get())) {
  constexpr double kEffort = 0.01, kRoot = 100.0;
  cost.effort = VectorX::Zero(model.nv);
  for (int i = 0; i < model.nv; ++i)
    (model.dofs[idx(i)].actuated ? cost.effort[i] : rootCost[i]) =
        model.dofs[idx(i)].actuated ? kEffort : kRoot * kEffort;
}

Problem Planner::problem() {
  Problem p{*model_, cost, knots_, rootCost, VectorX::Zero(model_->nv), VectorX::Zero(model_->nv),
            {}};
  for (int i = 0; i < model_->nv; ++i) {
    const Dof& dof = model_->dofs[idx(i)];
    if (!dof.actuated) continue;
    // A bound is kept by a price of a hundred times the effort at first.
    p.rootCost[i] = 100.0 * cost.effort[i];
    p.lower[i] = dof.effortLower, p.upper[i] = dof.effortUpper;
    p.controlled.push_back(i);
  }
  return p;
}

void Planner::runInfeasible(const PlanOptions& options, double start) {
  for (int i = 0; i < options.infeasible && now() - start < options.seconds; ++i) {
    infeasible_->iterate();
    ++plan_.infeasible;
    plan_.costs.push_back(infeasible_->lagrangian());
    if ((i + 1) % options.passEvery == 0 || i + 1 == options.infeasible)
      feasible_->take(infeasible_->trajectory(), infeasible_->values());
  }
}

void Planner::runFeasible(const PlanOptions& options, double start) {
  constexpr double kMostRho = 1e8, kSettled = 1e-2;
  plan_.status = PlanStatus::iterationLimit;
  for (int i = 0; i < options.feasible && now() - start < options.seconds; ++i) {
    const double before = feasible_->trajectory().cost;
    const bool moved = feasible_->iterate();
    const double after = feasible_->trajectory().cost;
    ++plan_.feasible;
    plan_.costs.push_back(after);
    plan_.certificate = feasible_->promised() / std::max(std::abs(before), 1e-300);
    if (moved && before - after <= options.tolerance * std::abs(before) &&
        feasible_->rho() < kSettled) {
      plan_.status = PlanStatus::converged;
      break;
    }
    if (!moved && std::abs(plan_.certificate) <= options.tolerance) {
      plan_.status = PlanStatus::converged;
      break;
    }
    if (feasible_->rho() > kMostRho) {
      plan_.status = PlanStatus::noDescent;
      break;
    }
  }
}

void Planner::publish(const Trajectory& x) {
  const auto count = static_cast<std::size_t>(knots_);
  plan_.q.resize(count + 1), plan_.v.resize(count + 1);
  plan_.a.resize(count), plan_.tau.resize(count);
  for (std::size_t t = 0; t <= count; ++t) {
    plan_.q[t] = x.knots[t].q, plan_.v[t] = x.knots[t].v;
    if (t < count) plan_.a[t] = x.knots[t].a, plan_.tau[t] = x.knots[t].tau;
  }
  plan_.cost = x.cost;
  plan_.rootForce = x.rootForce;
}

const MotionPlan& Planner::solve(const VectorX& q, const VectorX& v, const PlanOptions& options,
                                 const std::vector<VectorX>& accelerations) {
  const double start = now();
  plan_ = {};
  problem_ = std::make_unique<Problem>(problem());
  infeasible_ = std::make_unique<InfeasiblePhase>(*problem_, *dynamics_, options.inPhaseI);
  feasible_ = std::make_unique<FeasiblePhase>(*problem_, *dynamics_, options.inPhaseF);
  Trajectory begin(*problem_, *dynamics_);
  begin.knots[0].q = q, begin.knots[0].v = v;
  for (std::size_t t = 0; t < accelerations.size() && t + 1 < begin.knots.size(); ++t)
    begin.knots[t].a = accelerations[t];
  if (q.size() != model_->nq || v.size() != model_->nv || !infeasible_->start(begin)) return plan_;
  runInfeasible(options, start);
  if (!feasible_->hasTrajectory()) {
    plan_.status = PlanStatus::infeasible;
    publish(infeasible_->trajectory());
    plan_.gap = kInfinity;
  } else {
    runFeasible(options, start);
    publish(feasible_->trajectory());
    plan_.gap = feasible_->gap();
  }
  plan_.seconds = now() - start;
  return plan_;
}

}  // namespace softgauss::planning

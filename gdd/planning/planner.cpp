// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/planner.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "softgauss/engine/step/forward_derivative.hpp"

namespace softgauss::planning {
namespace {

double now() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

/// Of forward dynamics: two solves of one step from different starts differ by up to 3e-10 of the
/// acceleration at the default of 1e-12 (a hopper), and by 5e-12 with this.
constexpr double kTolerance = 1e-14;

std::unique_ptr<Model> planned(const Model& model, const PlanSteps& steps) {
  if (!(steps.step > 0.0 && steps.step < kInfinity))
    throw ModelError({}, "plan", "step is " + std::to_string(steps.step) + " s, expected > 0");
  if (steps.knots < 1)
    throw ModelError({}, "plan", "knots are " + std::to_string(steps.knots) + ", expected ≥ 1");
  auto copy = std::make_unique<Model>(model);
  copy->options = StepDerivative::bareStep(model.options);
  copy->options.timestep = steps.step;
  copy->options.tolerance = std::min(model.options.tolerance, kTolerance);
  return copy;
}

}  // namespace

std::string_view planStatusName(PlanStatus status) {
  switch (status) {
    case PlanStatus::converged:
      return "converged";
    case PlanStatus::iterationLimit:
      return "iteration limit";
    case PlanStatus::interrupted:
      return "interrupted";
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
      acting_(model.options),
      model_(planned(model, steps)),
      knots_(steps.knots),
      threads_(*model_, contacts, std::min(steps.threads, steps.knots)),
      problem_(problem()),
      infeasible_(problem_, threads_),
      feasible_(problem_, threads_),
      begin_(problem_, threads_.own()),
      kept_(begin_),
      keptAccelerations_(idx(steps.knots), VectorX::Zero(model.nv)),
      keptValues_(idx(steps.knots) + 1, ValueModel(model.nv)) {
  constexpr double kEffort = 0.01, kRoot = 100.0;
  mechanisms_ = model_->options.mechanisms;
  for (const Geometry& geometry : model_->geometries) own_.push_back(geometry.material);
  for (const ContactPair& pair : model_->contactPairs) own_.push_back(pair.material);
  cost.effort = VectorX::Zero(model.nv);
  for (int i = 0; i < model.nv; ++i)
    (model.dofs[idx(i)].actuated ? cost.effort[i] : rootCost[i]) =
        model.dofs[idx(i)].actuated ? kEffort : kRoot * kEffort;
}

void Planner::setContacts(const PlanningContacts& contacts) {
  contacts.check();
  for (const Mechanism m : {Mechanism::slipCorrection, Mechanism::nearRigid})
    model_->options.mechanisms.remove(m);
  makeContacts([&](const Material& own, double share) { return contacts.material(own, share); });
}

void Planner::setOwnContacts() {
  model_->options.mechanisms = mechanisms_;
  makeContacts([](const Material& own, double) { return own; });
}

/// What finds contacts knows their margins, so that it is made anew.
template <class F>
void Planner::makeContacts(const F& material) {
  auto own = own_.begin();
  for (Geometry& geometry : model_->geometries) geometry.material = material(*own++, 0.5);
  for (ContactPair& pair : model_->contactPairs) pair.material = material(*own++, 1.0);
  threads_.restart();
}

Problem Planner::problem() {
  Problem p{*model_,
            cost,
            knots_,
            VectorX::Zero(model_->nv),
            VectorX::Zero(model_->nv),
            VectorX::Zero(model_->nv),
            {}};
  for (int i = 0; i < model_->nv; ++i) {
    const Dof& dof = model_->dofs[idx(i)];
    if (!dof.actuated) continue;
    p.lower[i] = dof.effortLower, p.upper[i] = dof.effortUpper;
    p.controlled.push_back(i);
  }
  return p;
}

void Planner::setPrices() {
  problem_.rootCost = rootCost;
  // A bound is kept by a price of a hundred times the effort at first.
  for (const int i : problem_.controlled) problem_.rootCost[i] = 100.0 * cost.effort[i];
}

bool Planner::mayGoOn(const PlanOptions& options, double start) {
  if (progress && !plan_.costs.empty() && !progress(plan_)) stopped_ = true;
  return !stopped_ && now() - start < options.seconds;
}

void Planner::runInfeasible(const PlanOptions& options, double start) {
  for (int i = 0; i < options.infeasible && mayGoOn(options, start); ++i) {
    infeasible_.iterate();
    ++plan_.infeasible, ++plan_.iterations;
    plan_.cost = infeasible_.lagrangian();
    plan_.rootForce = infeasible_.trajectory().rootForce;
    plan_.costs.push_back(plan_.cost);
    if ((i + 1) % options.passEvery == 0 || i + 1 == options.infeasible)
      feasible_.take(infeasible_.trajectory(), infeasible_.values());
  }
}

void Planner::runFeasible(const PlanOptions& options, double start) {
  constexpr double kMostRho = 1e8, kSettled = 1e-2;
  plan_.status = PlanStatus::iterationLimit;
  for (int i = 0; i < options.feasible && mayGoOn(options, start); ++i) {
    const double before = feasible_.trajectory().cost;
    const bool moved = feasible_.iterate();
    const double after = feasible_.trajectory().cost;
    ++plan_.feasible, ++plan_.iterations;
    if (feasible_.refusedKnot() >= 0) {
      plan_.status = PlanStatus::refused;
      break;
    }
    plan_.cost = after, plan_.rootForce = 0.0;
    plan_.costs.push_back(after);
    plan_.certificate = feasible_.promised() / std::max(std::abs(before), 1e-300);
    if (moved && before - after <= options.tolerance * std::abs(before) &&
        feasible_.rho() < kSettled) {
      plan_.status = PlanStatus::converged;
      break;
    }
    if (!moved && std::abs(plan_.certificate) <= options.tolerance) {
      plan_.status = PlanStatus::converged;
      break;
    }
    if (feasible_.rho() > kMostRho) {
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
  State state(*model_);
  state.q = q, state.v = v;
  return solve(state, options, accelerations);
}

const MotionPlan& Planner::solve(const State& state, const PlanOptions& options,
                                 const std::vector<VectorX>& accelerations) {
  const double start = now();
  plan_.iterations = 0;
  run(state, options, accelerations, false);
  plan_.seconds = now() - start;
  return plan_;
}

/// The state and the accelerations with which both phases begin. False where they do not fit.
bool Planner::start(const State& state, const PlanOptions& options,
                    const std::vector<VectorX>& accelerations) {
  plan_.status = PlanStatus::refused;
  plan_.infeasible = plan_.feasible = 0;
  plan_.refusedKnot = -1;
  plan_.costs.clear();
  stopped_ = false;
  setPrices();
  feasible_.reset(options.inPhaseF);
  Knot& first = begin_.knots[0];
  if (state.q.size() != model_->nq || state.v.size() != model_->nv) return false;
  first.q = state.q, first.v = state.v;
  first.hasLast = state.hasAcceleration && state.a.size() == model_->nv;
  if (first.hasLast) first.last = state.a;
  for (std::size_t t = 0; t + 1 < begin_.knots.size(); ++t) {
    VectorX& a = begin_.knots[t].a;
    if (t < accelerations.size())
      a = accelerations[t];
    else
      a.setZero();
  }
  return true;
}

void Planner::run(const State& state, const PlanOptions& options,
                  const std::vector<VectorX>& accelerations, bool goesOn) {
  const double begin = now();
  if (!start(state, options, accelerations)) return;
  if (!infeasible_.start(begin_, options.inPhaseI)) {
    plan_.refusedKnot = infeasible_.refusedKnot();
    return;
  }
  if (goesOn) feasible_.take(kept_, keptValues_);
  runInfeasible(options, begin);
  finish(options, begin);
}

/// Phase F, and the plan.
void Planner::finish(const PlanOptions& options, double begin) {
  if (!feasible_.hasTrajectory()) {
    plan_.refusedKnot = infeasible_.refusedKnot();
    plan_.status = plan_.refusedKnot < 0 ? PlanStatus::infeasible : PlanStatus::refused;
    publish(infeasible_.trajectory());
    plan_.gap = kInfinity;
  } else {
    runFeasible(options, begin);
    plan_.refusedKnot = feasible_.refusedKnot();
    if (stopped_ && plan_.status != PlanStatus::refused) plan_.status = PlanStatus::interrupted;
    publish(feasible_.trajectory());
    plan_.gap = feasible_.gap();
  }
}

const MotionPlan& Planner::solveFeasible(const State& state, const PlanOptions& options,
                                         const std::vector<VectorX>& accelerations) {
  // Of errors of the next state: it is followed within some tenths of a second.
  constexpr double kPosition = 1000.0, kVelocity = 10.0;
  const double begin = now();
  plan_.iterations = 0;
  if (start(state, options, accelerations) && begin_.integrate(threads_.own())) {
    for (ValueModel& value : keptValues_) {
      value.slope.setZero();
      value.curvature.setZero();
      value.curvature.diagonal().head(model_->nv).setConstant(kPosition);
      value.curvature.diagonal().tail(model_->nv).setConstant(kVelocity);
    }
    for (Knot& knot : begin_.knots) knot.tau.setZero();
    if (feasible_.take(begin_, keptValues_)) {
      finish(options, begin);
    } else {
      plan_.status = PlanStatus::infeasible;
      publish(begin_);
      plan_.gap = plan_.cost = kInfinity;
    }
  }
  plan_.seconds = now() - begin;
  return plan_;
}

/// The plan, for the stages to come.
void Planner::keep() {
  kept_.copyMotion(feasible_.trajectory());
  keptAccelerations_ = plan_.a;
  keptValues_ = feasible_.values();
}

void Planner::takeKept() { feasible_.adopt(kept_, keptValues_); }

const MotionPlan& Planner::solve(const State& state, const Continuation& continuation,
                                 const PlanOptions& options,
                                 const std::vector<VectorX>& accelerations) {
  constexpr double kShortest = 1.0 / 16.0;
  const double start = now();
  PlanOptions between = options;
  between.infeasible = continuation.infeasible, between.feasible = continuation.feasible;
  setContacts(continuation.contacts);
  plan_.iterations = 0;
  run(state, options, accelerations, false);
  const double last = continuation.stages + 1.0;
  double stage = 0.0, step = 1.0;
  bool goesOn = feasible_.hasTrajectory();
  if (goesOn) keep();
  while (stage < last && !stopped_ && plan_.status != PlanStatus::refused) {
    const double next = std::min(stage + step, last), before = plan_.cost;
    PlanningContacts contacts = continuation.contacts;
    contacts.margin *= std::pow(continuation.factor, next);
    next < last ? setContacts(contacts) : setOwnContacts();
    if (!goesOn) keptAccelerations_ = plan_.a;
    run(state, next < last ? between : options, keptAccelerations_, goesOn);
    const bool found = feasible_.hasTrajectory();
    if (goesOn && step > kShortest && !(found && plan_.cost <= continuation.lost * before)) {
      if (stopped_) break;
      step *= 0.5;
      plan_.cost = before;
      continue;
    }
    stage = next, step = std::min(1.0, 2.0 * step);
    goesOn = found;
    if (found) keep();
  }
  if (stopped_ && stage < last && goesOn) settle(state, options);
  plan_.seconds = now() - start;
  return plan_;
}

/// Of a plan that was interrupted between stages, the last of which is kept: one pass on the
/// model's own contacts makes a plan of them.
void Planner::settle(const State& state, const PlanOptions& options) {
  setOwnContacts();
  if (!start(state, options, keptAccelerations_)) return;
  stopped_ = true;
  feasible_.take(kept_, keptValues_);
  finish(options, now());
}

}  // namespace softgauss::planning

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/feasible_phase.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::planning {

FeasiblePhase::FeasiblePhase(const Problem& problem, KnotThreads& threads)
    : problem_(problem),
      threads_(threads),
      dynamics_(threads.own()),
      cost_(problem),
      backward_(problem.model, problem.controlled),
      controller_(problem.model),
      x_(problem, dynamics_),
      trial_(x_),
      reference_(x_),
      best_(x_),
      values_(static_cast<std::size_t>(problem.knots) + 1, ValueModel(problem.model.nv)),
      otherValues_(values_),
      feedback_(static_cast<std::size_t>(problem.knots),
                Feedback(static_cast<int>(problem.controlled.size()), problem.model.nv)),
      otherFeedback_(feedback_),
      knotCost_(problem.model.nv),
      R_(VectorX::Zero(problem.model.nv)),
      metric_(VectorX::Ones(problem.model.nv)),
      free_(VectorX::Zero(problem.model.nv)),
      dx_(VectorX::Zero(2 * problem.model.nv)),
      dq_(free_),
      du_(VectorX::Zero(static_cast<Eigen::Index>(problem.controlled.size()))),
      control_(free_) {
  auto value = std::make_unique<gdd::QuadraticValue>(problem.model);
  value_ = value.get();
  controller_.goals.push_back(std::move(value));
  controller_.controlCost = gdd::ControlCost::total;
}

void FeasiblePhase::reset(const FeasibleOptions& options) {
  options_ = options;
  cost_.begin(problem_);
  R_ = problem_.h() * problem_.cost.effort;
  controller_.limits.lower = problem_.lower;
  controller_.limits.upper = problem_.upper;
  has_ = false;
  refusedKnot_ = -1;
  promised_ = kInfinity;
}

void FeasiblePhase::difference(const Knot& from, const Knot& to) {
  const Eigen::Index n = problem_.model.nv;
  positionDifference(problem_.model, from.q, to.q, dq_);
  dx_.head(n) = dq_;
  dx_.tail(n) = to.v - from.v;
}

/// One GDD solve at the state of `knot` for the value model of t + 1; sets its a and tau.
bool FeasiblePhase::solveGoal(int t, Knot& knot, double alpha) {
  const Knot &old = reference_.knots[idx(t)], &next = reference_.knots[idx(t + 1)];
  if (isRefused(dynamics_.stages(knot))) return false;
  difference(old, knot);
  const Feedback& f = feedback_[idx(t)];
  du_.noalias() = f.K * dx_;
  value_->q = next.q, value_->v = next.v;
  value_->slope = values_[idx(t + 1)].slope;
  value_->curvature = values_[idx(t + 1)].curvature;
  value_->about = old.a;
  control_.setZero();
  free_.setZero();
  for (std::size_t j = 0; j < problem_.controlled.size(); ++j) {
    const int i = problem_.controlled[j];
    const auto row = static_cast<Eigen::Index>(j);
    const double D = rho_ * f.diagonal[row];
    metric_[i] = R_[i] + D;
    free_[i] = (D * (old.tau[i] + du_[row]) + (1.0 - alpha) * f.slope[row]) / metric_[i];
    control_[i] =
        std::clamp(old.tau[i] + alpha * f.k[row] + du_[row], problem_.lower[i], problem_.upper[i]);
  }
  if (!(metric_.minCoeff() > 0.0) || !metric_.allFinite() || !free_.allFinite()) return false;
  controller_.forceMetric.setDiagonal(metric_);
  value_->freeControl = free_;
  WarmStart& warm = dynamics_.middle.warmstart;
  warm.a = warm.gddA = old.a;
  warm.control = control_;
  warm.multipliers.setZero(problem_.model.nv);
  warm.breakpoints.clear();
  warm.valid = warm.gddValid = true;
  controller_.begin();
  const VectorX* a = controller_.apply(problem_.model, dynamics_.middle, dynamics_.data());
  if (!a) return false;
  knot.tau = controller_.control;
  // What moves is what the controls cause.
  if (isRefused(dynamics_.forward(knot.tau, a))) return false;
  knot.a = dynamics_.data().forward.a;
  return true;
}

bool FeasiblePhase::solveControls(int t, Knot& knot, double alpha) {
  const Knot& old = reference_.knots[idx(t)];
  difference(old, knot);
  const Feedback& f = feedback_[idx(t)];
  du_ = alpha * f.k;
  du_.noalias() += f.K * dx_;
  knot.tau.setZero();
  for (std::size_t j = 0; j < problem_.controlled.size(); ++j) {
    const int i = problem_.controlled[j];
    knot.tau[i] = std::clamp(old.tau[i] + du_[static_cast<Eigen::Index>(j)], problem_.lower[i],
                             problem_.upper[i]);
  }
  if (isRefused(dynamics_.stages(knot)) || isRefused(dynamics_.forward(knot.tau, &old.a)))
    return false;
  knot.a = dynamics_.data().forward.a;
  return true;
}

bool FeasiblePhase::pass(double alpha, bool goalDirected, Trajectory& y) {
  for (int t = 0; t < problem_.knots; ++t) {
    Knot &knot = y.knots[idx(t)], &next = y.knots[idx(t + 1)];
    if (!(goalDirected ? solveGoal(t, knot, alpha) : solveControls(t, knot, alpha))) return false;
    dynamics_.move(knot, next);
    if (!next.q.allFinite() || !next.v.allFinite() ||
        next.v.cwiseAbs().maxCoeff() > options_.mostSpeed)
      return false;
  }
  cost_.evaluate(problem_, y);
  return std::isfinite(y.cost);
}

bool FeasiblePhase::take(const Trajectory& about, const std::vector<ValueModel>& values,
                         bool always) {
  reference_.copyMotion(about);
  values_ = values;
  forgetFeedback();
  trial_.knots[0].copyState(reference_.knots[0]);
  if (!pass(1.0, true, trial_)) return false;
  if (has_ && !always && !(trial_.cost < x_.cost)) return false;
  begin();
  return true;
}

void FeasiblePhase::forgetFeedback() {
  for (Feedback& f : feedback_) {
    f.k.setZero(), f.K.setZero(), f.slope.setZero(), f.diagonal.setZero();
  }
}

/// What passes are about, moved on by some knots; what there was is in otherValues_ and
/// otherFeedback_.
void FeasiblePhase::moveOn(int knots) {
  const int last = problem_.knots;
  for (int t = 0; t <= last; ++t) {
    const int from = std::min(t + knots, last);
    reference_.knots[idx(t)].copyState(x_.knots[idx(from)]);
    otherValues_[idx(t)].slope = values_[idx(from)].slope;
    otherValues_[idx(t)].curvature = values_[idx(from)].curvature;
    if (t == last) continue;
    const auto control = idx(std::min(from, last - 1));
    const Knot& move = x_.knots[control];
    reference_.knots[idx(t)].a = move.a, reference_.knots[idx(t)].tau = move.tau;
    otherFeedback_[idx(t)] = feedback_[control];
  }
  values_.swap(otherValues_);
  feedback_.swap(otherFeedback_);
}

bool FeasiblePhase::shift(int knots, const Knot& start, bool whatever) {
  constexpr double kLost = 3.0;
  struct Pass {
    double alpha;
    bool goalDirected;
    double rho;
  };
  moveOn(knots);
  difference(reference_.knots[0], start);
  knotCost_.slope.noalias() = values_[0].curvature * dx_;
  const double change = values_[0].slope.dot(dx_) + 0.5 * knotCost_.slope.dot(dx_);
  const double most = kLost * (x_.cost + std::max(change, 0.0));
  double least = kInfinity;
  for (const Pass& p : {Pass{1.0, true, 0.0}, {0.0, false, 0.0}, {1.0, true, 1.0}}) {
    rho_ = p.rho;
    trial_.knots[0].copyState(start);
    if (!pass(p.alpha, p.goalDirected, trial_)) continue;
    if (trial_.cost <= most) {
      begin();
      return true;
    }
    if (trial_.cost < least) {
      least = trial_.cost;
      std::swap(trial_, best_);
    }
  }
  if (whatever && least < kInfinity) {
    std::swap(trial_, best_);
    begin();
    return true;
  }
  rho_ = 0.0;
  values_.swap(otherValues_);
  feedback_.swap(otherFeedback_);
  return false;
}

bool FeasiblePhase::takeCosts() {
  cost_.begin(problem_);
  cost_.evaluate(problem_, x_);
  fresh_ = true;
  return std::isfinite(x_.cost) && refresh();
}

bool FeasiblePhase::refresh() {
  constexpr double kMostGrowth = 1e5;
  const auto largest = [](const std::vector<ValueModel>& values) {
    double most = 0.0;
    for (const ValueModel& value : values)
      most = std::max(most, value.curvature.lpNorm<Eigen::Infinity>());
    return most;
  };
  if (fresh_ && !linearise()) return false;
  const double before = largest(values_);
  if (!backward()) return false;
  if (largest(values_) <= kMostGrowth * before) return true;
  values_.swap(otherValues_);
  feedback_.swap(otherFeedback_);
  return false;
}

/// From the trajectory that was tried.
void FeasiblePhase::begin() {
  std::swap(x_, trial_);
  has_ = fresh_ = true;
  rho_ = 0.0, growth_ = 1.0;
}

void FeasiblePhase::adopt(const Trajectory& x, const std::vector<ValueModel>& values) {
  trial_.copyMotion(x);
  values_ = values;
  cost_.evaluate(problem_, trial_);
  begin();
}

bool FeasiblePhase::rollOut(const Knot& start, const std::vector<VectorX>& controls) {
  reference_.knots[0].copyState(start);
  forgetFeedback();
  trial_.knots[0].copyState(start);
  for (int t = 0; t < problem_.knots; ++t) {
    reference_.knots[idx(t)].tau = controls[idx(t)];
    reference_.knots[idx(t)].a.setZero();
  }
  if (!pass(0.0, false, trial_)) return false;
  begin();
  return true;
}

bool FeasiblePhase::refuse(int knot) {
  refusedKnot_ = knot;
  return false;
}

bool FeasiblePhase::backward() {
  const int last = problem_.knots;
  backward_.begin();
  refusedKnot_ = -1;
  ValueModel* next = &otherValues_.back();
  if (!cost_.expand(problem_, x_.knots.back(), last, *next)) return refuse(last);
  next->mirror();
  for (int t = last - 1; t >= 0; --t) {
    const Knot& knot = x_.knots[idx(t)];
    ValueModel& value = otherValues_[idx(t)];
    if (!cost_.expand(problem_, knot, t, knotCost_)) return refuse(t);
    if (!backward_.overControls(knot, *next, knotCost_, R_, problem_.lower, problem_.upper, rho_,
                                otherFeedback_[idx(t)], value))
      return false;
    if (!value.slope.allFinite() || !value.curvature.allFinite()) return refuse(t);
    next = &value;
  }
  values_.swap(otherValues_);
  feedback_.swap(otherFeedback_);
  promised_ = -(backward_.linear() + backward_.quadratic());
  return true;
}

bool FeasiblePhase::linearise() {
  fresh_ = !threads_.atAll(problem_.knots, [&](PlanDynamics& dynamics, int t) {
    constexpr bool kKeepsForce = true;  // what was applied; g is it to rounding
    return !isRefused(dynamics.linearise(x_.knots[idx(t)], kKeepsForce));
  });
  return !fresh_;
}

bool FeasiblePhase::iterate() {
  constexpr double kArmijo = 1e-4, kShorter = 0.4, kLeastRho = 1e-3, kNoRho = 1e-8;
  if (fresh_ && !linearise()) return false;
  bool moved = false;
  if (backward()) {
    reference_.copyMotion(x_);
    trial_.knots[0].copyState(x_.knots[0]);
    alpha_ = 1.0;
    for (int length = 0; length < options_.lengths && !moved; ++length) {
      for (const bool goalDirected : {true, false}) {
        if (!(goalDirected ? options_.goalDirected : options_.plainControls)) continue;
        if (!pass(alpha_, goalDirected, trial_)) continue;
        const double model =
            -(alpha_ * backward_.linear() + alpha_ * alpha_ * backward_.quadratic());
        moved = x_.cost - trial_.cost > kArmijo * std::max(model, 0.0) && trial_.cost < x_.cost;
        if (moved) break;
      }
      if (!moved) alpha_ *= kShorter;
    }
  }
  if (moved) {
    std::swap(x_, trial_);
    fresh_ = true;
    growth_ = std::min(0.5 * growth_, 0.5);
    rho_ *= growth_;
    if (rho_ < kNoRho) rho_ = 0.0;
  } else {
    growth_ = std::max(2.0 * growth_, 2.0);
    rho_ = std::max(kLeastRho, growth_ * rho_);
  }
  return moved;
}

double FeasiblePhase::gap() {
  double worst = 0.0;
  for (int t = 0; t < problem_.knots; ++t) {
    const Knot& knot = x_.knots[idx(t)];
    if (isRefused(dynamics_.stages(knot)) || isRefused(dynamics_.forward(knot.tau, nullptr)))
      return kInfinity;
    const double size = std::max(1.0, knot.a.cwiseAbs().maxCoeff());
    worst = std::max(worst, (dynamics_.data().forward.a - knot.a).cwiseAbs().maxCoeff() / size);
  }
  return worst;
}

}  // namespace softgauss::planning

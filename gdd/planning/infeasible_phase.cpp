// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/infeasible_phase.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::planning {
namespace {

/// ρ where it is not 0, and from where on no step is to be hoped for.
constexpr double kLeastRho = 1e-3, kMostRho = 1e8;

}  // namespace

InfeasiblePhase::InfeasiblePhase(const Problem& problem, KnotThreads& threads)
    : problem_(problem),
      threads_(threads),
      cost_(problem),
      pass_(problem.model, problem.controlled),
      x_(problem, threads.own()),
      trial_(x_),
      values_(static_cast<std::size_t>(problem.knots) + 1, ValueModel(problem.model.nv)),
      feedback_(static_cast<std::size_t>(problem.knots),
                Feedback(problem.model.nv, problem.model.nv)),
      lambda_(static_cast<std::size_t>(problem.knots), VectorX::Zero(problem.model.nv)),
      direction_(lambda_),
      knotCost_(problem.model.nv),
      mu_(VectorX::Zero(problem.model.nv)),
      w_(mu_),
      W_(mu_),
      dx_(VectorX::Zero(2 * problem.model.nv)),
      dxNext_(dx_) {}

InfeasiblePhase::ForceCost InfeasiblePhase::forceCost(int t, int i, double f) const {
  const double h = problem_.h(), l = lambda_[idx(t)][i], mu = mu_[i];
  if (!problem_.isControlled(i)) return {h * (l * f + 0.5 * mu * f * f), h * (l + mu * f), h * mu};
  const double R = problem_.cost.effort[i];
  ForceCost c{0.5 * R * f * f, R * f, R};
  const double above = l + mu * (f - problem_.upper[i]), below = l + mu * (f - problem_.lower[i]);
  const double pull = above > 0.0 ? above : (below < 0.0 ? below : 0.0);
  if (pull != 0.0) c = {c.value + 0.5 * pull * pull / mu, c.slope + pull, c.curvature + mu};
  if (l != 0.0) c.value -= 0.5 * l * l / mu;
  return {h * c.value, h * c.slope, h * c.curvature};
}

double InfeasiblePhase::evaluate(Trajectory& x) {
  cost_.evaluate(problem_, x);
  double L = x.cost;
  for (int t = 0; t < problem_.knots; ++t) {
    for (int i = 0; i < problem_.model.nv; ++i) {
      const double f = x.knots[idx(t)].tau[i];
      L += forceCost(t, i, f).value;
      if (problem_.isControlled(i)) L -= 0.5 * problem_.h() * problem_.cost.effort[i] * f * f;
    }
  }
  return L;
}

bool InfeasiblePhase::start(const Trajectory& x, const InfeasibleOptions& options) {
  options_ = options;
  cost_.begin(problem_);
  for (std::size_t t = 0; t < x_.knots.size(); ++t) x_.knots[t].a = x.knots[t].a;
  x_.knots[0].copyState(x.knots[0]);
  trial_.knots[0].copyState(x.knots[0]);
  mu_ = options_.mu * problem_.rootCost;
  for (VectorX& l : lambda_) l.setZero();
  rho_ = options_.rho, lastViolation_ = kInfinity, sinceUpdate_ = 0, fresh_ = true;
  refusedKnot_ = -1;
  if (!x_.integrate(threads_.own()) || !x_.findForces(threads_)) return false;
  L_ = evaluate(x_);
  refusedKnot_ = x_.notFinite;
  return std::isfinite(L_);
}

bool InfeasiblePhase::linearise() {
  fresh_ = !threads_.atAll(problem_.knots, [&](PlanDynamics& dynamics, int t) {
    return !isRefused(dynamics.linearise(x_.knots[idx(t)]));
  });
  return !fresh_;
}

bool InfeasiblePhase::refuse(int knot) {
  refusedKnot_ = knot;
  return false;
}

bool InfeasiblePhase::backward() {
  pass_.begin();
  refusedKnot_ = -1;
  if (!cost_.expand(problem_, x_.knots.back(), problem_.knots, values_.back()))
    return refuse(problem_.knots);
  values_.back().mirror();
  for (int t = problem_.knots - 1; t >= 0; --t) {
    const Knot& knot = x_.knots[idx(t)];
    if (!cost_.expand(problem_, knot, t, knotCost_)) return refuse(t);
    for (int i = 0; i < problem_.model.nv; ++i) {
      const ForceCost c = forceCost(t, i, knot.tau[i]);
      w_[i] = c.slope, W_[i] = c.curvature;
    }
    if (!pass_.overAccelerations(knot, values_[idx(t + 1)], knotCost_, w_, W_, rho_,
                                 feedback_[idx(t)], values_[idx(t)]))
      return false;
  }
  return true;
}

/// The linear rollout: exact for (23), so that one direction serves all α.
void InfeasiblePhase::findDirection() {
  dx_.setZero();
  for (int t = 0; t < problem_.knots; ++t) {
    VectorX& da = direction_[idx(t)];
    da = feedback_[idx(t)].k;
    da.noalias() += feedback_[idx(t)].K * dx_;
    x_.knots[idx(t)].transition.next(dx_, da, dxNext_);
    dx_.swap(dxNext_);
  }
}

bool InfeasiblePhase::search() {
  constexpr double kArmijo = 1e-4;
  alpha_ = 1.0;
  for (int halving = 0; halving <= options_.halvings; ++halving, alpha_ *= 0.5) {
    for (int t = 0; t < problem_.knots; ++t)
      trial_.knots[idx(t)].a = x_.knots[idx(t)].a + alpha_ * direction_[idx(t)];
    if (!trial_.integrate(threads_.own()) || !trial_.findForces(threads_)) continue;
    const double L = evaluate(trial_);
    const double promised = -(alpha_ * pass_.linear() + alpha_ * alpha_ * pass_.quadratic());
    if (!(L_ - L > kArmijo * std::max(promised, 0.0) && L < L_)) continue;
    const double kept = alpha_ * (L_ - L) / std::max(promised, std::abs(L) * 1e-16);
    std::swap(x_, trial_);
    L_ = L;
    if (kept > 0.5)
      rho_ = rho_ < kLeastRho ? 0.0 : 0.25 * rho_;
    else if (kept < 0.2)
      rho_ = std::max(kLeastRho, 4.0 * rho_);
    return true;
  }
  return false;
}

bool InfeasiblePhase::iterate() {
  constexpr double kFlat = 1e-3;
  if (fresh_ && !linearise()) return false;
  const double before = L_;
  bool moved = false;
  if (backward()) {
    findDirection();
    moved = search();
  }
  if (moved)
    fresh_ = true;
  else
    rho_ = std::max(kLeastRho, 10.0 * rho_);
  const bool stuck = rho_ > kMostRho;
  const bool flat = moved && before - L_ < kFlat * std::abs(before);
  if (++sinceUpdate_ >= options_.inner || flat || stuck) updateMultipliers();
  if (stuck) rho_ = kLeastRho;
  return moved;
}

void InfeasiblePhase::updateMultipliers() {
  sinceUpdate_ = 0;
  const double violation = std::max(x_.rootForce, x_.excess);
  for (int t = 0; t < problem_.knots; ++t) {
    for (int i = 0; i < problem_.model.nv; ++i) {
      const double f = x_.knots[idx(t)].tau[i];
      double& l = lambda_[idx(t)][i];
      if (!problem_.isControlled(i))
        l += mu_[i] * f;
      else if (std::isfinite(problem_.upper[i]) || std::isfinite(problem_.lower[i]))
        l = std::max(0.0, l + mu_[i] * (f - problem_.upper[i])) +
            std::min(0.0, l + mu_[i] * (f - problem_.lower[i]));
    }
  }
  if (violation > 0.25 * lastViolation_)
    mu_ = (options_.growth * mu_).cwiseMin(options_.muMost * problem_.rootCost);
  lastViolation_ = violation;
  L_ = evaluate(x_);
}

}  // namespace softgauss::planning

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/trajectory.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::planning {

Trajectory::Trajectory(const Problem& problem, const PlanDynamics& dynamics)
    : knots(static_cast<std::size_t>(problem.knots) + 1, Knot(problem.model, dynamics.step())) {}

bool Trajectory::integrate(const PlanDynamics& dynamics) {
  for (std::size_t t = 0; t + 1 < knots.size(); ++t) {
    Knot& next = knots[t + 1];
    dynamics.move(knots[t], next);
    if (!next.q.allFinite() || !next.v.allFinite()) return false;
  }
  return true;
}

void Trajectory::copyMotion(const Trajectory& from) {
  for (std::size_t t = 0; t < knots.size(); ++t) {
    const Knot& knot = from.knots[t];
    knots[t].copyState(knot);
    knots[t].a = knot.a, knots[t].tau = knot.tau;
  }
}

bool Trajectory::findForces(KnotThreads& threads) {
  return threads.atAll(static_cast<int>(knots.size()) - 1, [&](PlanDynamics& dynamics, int t) {
    Knot& knot = knots[idx(t)];
    return !isRefused(dynamics.inverse(knot)) && knot.tau.allFinite();
  });
}

void TrajectoryCost::begin(const Problem& problem) {
  needsKinematics_ = false;
  for (const auto* terms : {&problem.cost.running, &problem.cost.final})
    for (const auto& term : *terms) needsKinematics_ = needsKinematics_ || term->needsKinematics();
}

KnotView TrajectoryCost::view(const Problem& problem, const Knot& knot, int t) {
  if (needsKinematics_) {
    state_.q = knot.q, state_.v = knot.v;
    computeKinematics(problem.model, state_, kinematics_);
  }
  const int at = t < problem.knots ? t + problem.cost.passed : t;
  return {problem.model, knot.q, knot.v, at, needsKinematics_ ? &kinematics_ : nullptr};
}

template <class F>
void TrajectoryCost::forTerms(const Problem& problem, int t, const F& f) {
  const bool last = t == problem.knots;
  if (!last)
    for (const auto& term : problem.cost.running) f(*term, problem.h());
  const bool kept = problem.cost.keepsEnd && t + problem.cost.passed >= problem.knots;
  if (last || kept)
    for (const auto& term : problem.cost.final) f(*term, last ? 1.0 : problem.h());
}

double TrajectoryCost::value(const Problem& problem, const Knot& knot, int t) {
  const KnotView at = view(problem, knot, t);
  double cost = 0.0;
  forTerms(problem, t, [&](CostTerm& term, double scale) { cost += scale * term.value(at); });
  return cost;
}

bool TrajectoryCost::expand(const Problem& problem, const Knot& knot, int t, ValueModel& model) {
  const KnotView at = view(problem, knot, t);
  model.slope.setZero();
  model.curvature.setZero();
  forTerms(problem, t, [&](CostTerm& term, double scale) {
    term.expand(at, scale, model.slope, model.curvature);
  });
  return model.slope.allFinite() && model.curvature.allFinite();
}

void TrajectoryCost::evaluate(const Problem& problem, Trajectory& x) {
  x.cost = value(problem, x.knots.back(), problem.knots);
  x.notFinite = std::isfinite(x.cost) ? -1 : problem.knots;
  x.rootForce = x.excess = 0.0;
  for (int t = 0; t < problem.knots; ++t) {
    const Knot& knot = x.knots[idx(t)];
    x.cost += value(problem, knot, t);
    for (int i = 0; i < problem.model.nv; ++i) {
      const double f = knot.tau[i];
      if (problem.isControlled(i)) {
        x.cost += 0.5 * problem.h() * problem.cost.effort[i] * f * f;
        x.excess = std::max({x.excess, f - problem.upper[i], problem.lower[i] - f});
      } else {
        x.rootForce = std::max(x.rootForce, std::abs(f));
      }
    }
    if (x.notFinite < 0 && !std::isfinite(x.cost)) x.notFinite = t;
  }
}

}  // namespace softgauss::planning

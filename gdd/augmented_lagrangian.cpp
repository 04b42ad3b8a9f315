// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/augmented_lagrangian.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::gdd {

AugmentedLagrangian::AugmentedLagrangian(const Model& model)
    : hessian_(model), held_(model.nv), ray_(model), curvedRay_(model) {
  for (VectorX* x : {&a_, &g_, &Ma_, &Rg_, &y_, &lambda_, &rho_, &slope_, &curvature_, &w_,
                     &gradient_, &costGradient_, &direction_, &Md_, &scratch_})
    *x = VectorX::Zero(model.nv);
}

void AugmentedLagrangian::evaluate(Data& data) {
  data.inertia.M.multiply(a_, Ma_);
  data.constraints.setResidual(a_);
  held_.place(data.constraints);
  data.constraints.evaluate(rowsChanged_);
  // −g = Jᵀf − M̂ a − c, as addForce() adds.
  g_ = -Ma_ - data.inertia.added.cwiseProduct(a_) - data.forces.c;
  data.constraints.addForce(g_);
  g_ = -g_;
}

/// w and ∇Φ at the present point; false when not finite.
bool AugmentedLagrangian::gradient(const BoundPenalty& bounds, const GoalCost& cost, Data& data) {
  cost.controlCost().multiply(massFactor_, g_, Rg_);
  bounds.limits.coordinates(g_, y_);
  penalty_ = 0.0;
  for (Eigen::Index i = 0; i < y_.size(); ++i) {
    const Jet psi = bounds.at(i, y_[i]);
    penalty_ += psi.value;
    slope_[i] = psi.slope;
    boundsChanged_ |= curvature_[i] != psi.curvature;
    curvature_[i] = psi.curvature;
  }
  w_ = Rg_;
  if (cost.controlCost().hasFree()) w_ -= cost.controlCost().freeSlope();
  bounds.limits.addSlope(slope_, w_);
  if (rowsChanged_) {
    hessian_.setCell(data);
    rowsChanged_ = false;
    stale_ = true;
  }
  hessian_.multiplyP(w_, gradient_);
  cost.gradient(a_, Ma_, costGradient_);
  if (forces_.active()) {
    forces_.evaluate(data.constraints);
    forces_.addGradient(data.constraints, costGradient_);
  }
  gradient_ += costGradient_;
  return gradient_.allFinite();
}

/// The Gauss–Newton direction, within the kink where rows are held; returns −∇Φ·d = dᵀH d.
double AugmentedLagrangian::direction() {
  direction_ = -gradient_;
  hessian_.solve(direction_);
  if (!held_.empty()) held_.project(direction_, [&](VectorX& x) { hessian_.solve(x); });
  return -gradient_.dot(direction_);
}

/// ∇Φ + J_Kᵀ μ, entries scaled to one unit.
double AugmentedLagrangian::stationarity(const VectorX& forceScale) {
  scratch_ = gradient_;
  for (int i = 0; i < held_.size(); ++i) scratch_ += held_[i].multiplier * held_[i].J;
  const double scale = costGradient_.cwiseProduct(forceScale).cwiseAbs().maxCoeff();
  return scratch_.cwiseProduct(forceScale).cwiseAbs().maxCoeff() / std::max(1.0, scale);
}

/// Distance from the bounds in force, as force, also from inside, where a λ too large holds y off.
double AugmentedLagrangian::gap(const ControlLimits& limits) const {
  double most = 0.0;
  for (Eigen::Index i = 0; i < rho_.size(); ++i)
    most = std::max(most, std::abs((slope_[i] - lambda_[i]) / rho_[i]) * limits.forcePerUnit(i));
  return most;
}

/// ρ as R has it: penalty · w, or more where R is larger; of a coordinate, along its column of T.
/// w, the inverse inertia of a dof, with what implicit forces add: 1/(1/w + added).
void AugmentedLagrangian::setPenalties(const GoalCost& cost, const ControlLimits& limits,
                                       const Data& data) {
  scratch_ = Eigen::Map<const VectorX>(data.weights.dof.data(), rho_.size());
  scratch_.array() /= 1.0 + scratch_.array() * data.inertia.added.array();
  if (!cost.controlCost().hasInverseMass()) {
    w_ = cost.controlCost().diagonal();
    for (int k = 0; k < cost.controlCost().directionCount(); ++k)
      w_ += cost.controlCost().direction(k).cwiseAbs2();
    scratch_ = scratch_.cwiseMax(w_);
  }
  for (Eigen::Index i = 0; i < rho_.size(); ++i)
    rho_[i] = options.penalty * (limits.isPlain(i)
                                     ? scratch_[i]
                                     : limits.transmission->T().col(i).cwiseAbs2().dot(scratch_));
}

void AugmentedLagrangian::start(const GoalCost& cost, const ControlLimits& limits, Data& data,
                                const WarmStart& warm) {
  setPenalties(cost, limits, data);
  if (warm.gddValid && warm.gddA.allFinite() && warm.multipliers.allFinite()) {
    a_ = warm.gddA;
    lambda_ = warm.multipliers;
  } else {
    lambda_.setZero();
    a_ = -data.forces.c;
    massFactor_.solve(a_);
  }
  held_.clear();
  forces_.setCost(cost.forces());
  rowsChanged_ = boundsChanged_ = stale_ = true;
  curvature_.setConstant(-1.0);
  evaluate(data);
}

GddReport AugmentedLagrangian::solve(const Model& model, GoalCost& cost,
                                     const ControlLimits& limits, Data& data,
                                     const WarmStart& warm) {
  badBound_ = limits.firstBad(model.nv);
  if (badBound_ >= 0) return {.status = GddStatus::badLimits};
  GddReport report = minimizeFrom(model, cost, limits, data, warm);
  if (report.status != GddStatus::notFinite || !warm.gddValid || massFactor_.failedRow() >= 0 ||
      !data.forces.c.allFinite())
    return report;
  // Multipliers that an unfinished solve left may make a matrix that cannot be factored.
  const GddReport first = report;
  report = minimizeFrom(model, cost, limits, data, WarmStart{});
  report.iterations += first.iterations;
  report.dualUpdates += first.dualUpdates;
  report.factorizations += first.factorizations;
  report.restarts = 1;
  return report;
}

GddReport AugmentedLagrangian::minimizeFrom(const Model& model, GoalCost& cost,
                                            const ControlLimits& limits, Data& data,
                                            const WarmStart& warm) {
  GddReport report;
  const auto end = [&](GddStatus status) {
    report.status = status;
    return report;
  };
  if (model.nv == 0) return report;
  const TreeMatrix& M = data.inertia.M;
  if (!data.forces.c.allFinite() || !massFactor_.compute(data.inertia.hat()))
    return end(GddStatus::notFinite);
  cost.prepareControlCost(massFactor_);
  start(cost, limits, data, warm);
  const BoundPenalty bounds{limits, lambda_, rho_, &cost.controlCost()};
  const double forceScale = std::max(1.0, data.forces.c.cwiseAbs().maxCoeff());
  double predicted = kInfinity, lastViolation = kInfinity;
  bool wholeStep = false;  // the last step met no breakpoint
  constexpr double kSmallGradient = 1e-6;
  bool lastTaken = false;  // its decrement was one that the objective cannot show

  for (;;) {
    if (!gradient(bounds, cost, data)) return end(GddStatus::notFinite);
    report.violation = limits.violation(g_);
    report.objective = cost.controlCost().value(g_, Rg_) + cost.value(a_, Ma_) + forces_.value();
    if (report.iterations == options.maxIterations || options.deadline.isOver())
      return end(GddStatus::iterationLimit);

    // Direction in this cell.
    const bool sameCell = !stale_ && !boundsChanged_ && wholeStep;
    wholeStep = false;
    if (stale_ || boundsChanged_) {
      ++report.factorizations;
      if (!hessian_.factorize(data, massFactor_, curvature_, limits, cost, forces_))
        return end(GddStatus::notFinite);
      stale_ = boundsChanged_ = false;
    }
    const double decrement = direction();
    report.stationarity = stationarity(data.inertia.forceScale);

    // Stationary: leave a kink, or update the multipliers, or done. A second full step in one cell
    // that promises no less than the first has reached rounding. A decrement that the objective
    // cannot show leaves a gradient of its root times the stiffness of H: where nothing is held,
    // one more step is worth taking if that gradient is large.
    const double merit = std::abs(report.objective) + cost.controlCost().freeCost() + penalty_;
    const bool unseen = decrement <= 1e-14 * merit;
    const bool last = unseen && held_.empty() && !lastTaken && report.stationarity > kSmallGradient;
    const bool rounding = (unseen && !last) || (sameCell && decrement > 0.01 * predicted);
    if (report.stationarity <= options.gradientTolerance || rounding) {
      bool towardsStiff = false;
      const int leaving = held_.leaving(w_, forces_, data.constraints, towardsStiff);
      if (leaving >= 0) {
        if (towardsStiff) {
          data.constraints.placeAtBreakpoint(held_[leaving].breakpoint, true);
          data.constraints.evaluate(rowsChanged_);
        }
        held_.release(leaving);
        ++report.iterations;
        continue;
      }
      const double off = gap(limits);
      const bool feasible = off <= options.violationTolerance * forceScale;
      const bool noBetter =
          off > 0.5 * lastViolation && off <= 1e2 * options.violationTolerance * forceScale;
      if (feasible || noBetter)
        return end(held_.empty() ? GddStatus::converged : GddStatus::nonsmoothMinimum);
      if (report.dualUpdates == options.maxDualUpdates) return end(GddStatus::iterationLimit);
      lambda_ = slope_;
      lastViolation = off;
      ++report.dualUpdates;
      continue;
    }

    lastTaken = last;
    // Exact line search; a minimum at a breakpoint holds its row there.
    data.constraints.setRay(direction_);
    held_.holdOnRay(data.constraints);
    hessian_.multiplyP(direction_, scratch_);
    M.multiply(direction_, Md_);
    double costSlope = costGradient_.dot(direction_);
    if (forces_.active()) {
      data.constraints.setForceRate();
      forces_.setRate(data.constraints);
      costSlope -= forces_.slope();
    }
    const double costCurvature = cost.curvatureAlong(direction_, Md_);
    Md_ += data.inertia.added.cwiseProduct(direction_);  // M̂ d
    const RayResult ray = data.constraints.piecewiseQuadratic()
                              ? ray_.minimize(data.constraints, massFactor_, bounds, g_, scratch_,
                                              costSlope, costCurvature, forces_)
                              : curvedRay_.minimize(data.constraints, massFactor_, bounds, g_, Md_,
                                                    costSlope, costCurvature, forces_);
    if (ray.bend && ray.alpha * decrement <= 1e-10 * merit) {
      evaluate(data);
      return end(GddStatus::nonsmoothStall);
    }
    ++report.iterations;
    a_ += ray.alpha * direction_;
    if (ray.kink) held_.hold(ray.last, data.constraints);
    evaluate(data);
    wholeStep = ray.crossings == 0;
    predicted = decrement;
  }
}

int AugmentedLagrangian::badDof() const {
  if (badBound_ >= 0) return badBound_;
  if (massFactor_.failedRow() >= 0) return massFactor_.failedRow();
  for (int i = 0; i < gradient_.size(); ++i)
    if (!std::isfinite(gradient_[i])) return i;
  return -1;
}

void AugmentedLagrangian::keepWarmStart(WarmStart& warm) const {
  warm.gddA = a_;
  warm.multipliers = lambda_;
  warm.control.setZero(a_.size());
  warm.breakpoints.clear();
  warm.gddValid = true;
}

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#include "gdd/augmented_lagrangian.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::gdd {

AugmentedLagrangian::AugmentedLagrangian(const Model& model) : hessian_(model), ray_(model) {
  for (VectorX* x : {&a_, &g_, &Ma_, &Rg_, &lambda_, &rho_, &slope_, &curvature_, &w_, &gradient_,
                     &costGradient_, &direction_, &Md_, &scratch_})
    *x = VectorX::Zero(model.nv);
}

void AugmentedLagrangian::evaluate(Data& data) {
  data.inertia.M.multiply(a_, Ma_);
  data.constraints.setResidual(a_);
  data.constraints.evaluate(rowsChanged_);
  // −g = Jᵀf − M a − c, as addForce() adds.
  g_ = -Ma_ - data.forces.c;
  data.constraints.addForce(g_);
  g_ = -g_;
}

/// w, ∇Φ and the objective at the present point; returns the stationarity.
double AugmentedLagrangian::gradient(const GoalCost& cost, const ControlBox& box, Data& data) {
  const BoundPenalty bounds{box, lambda_, rho_};
  Rg_ = g_;
  massFactor_.solve(Rg_);
  penalty_ = 0.0;
  for (Eigen::Index i = 0; i < g_.size(); ++i) {
    const Jet psi = bounds.at(i, g_[i]);
    penalty_ += psi.value;
    w_[i] = Rg_[i] + psi.slope;
    slope_[i] = psi.slope;
    boundsChanged_ |= curvature_[i] != psi.curvature;
    curvature_[i] = psi.curvature;
  }
  if (rowsChanged_) {
    hessian_.setCell(data);
    rowsChanged_ = false;
    stale_ = true;
  }
  hessian_.multiplyP(w_, gradient_);
  cost.gradient(data.inertia.M, a_, Ma_, costGradient_);
  gradient_ += costGradient_;

  double scale = 1.0, largest = 0.0;
  for (int i = 0; i < g_.size(); ++i) {
    const double root = 1.0 / std::sqrt(data.inertia.M.row(i)[i]);
    largest = std::max(largest, std::abs(gradient_[i]) * root);
    scale = std::max(scale, std::abs(costGradient_[i]) * root);
    if (!std::isfinite(gradient_[i])) return kNaN;
  }
  return largest / scale;
}

GddReport AugmentedLagrangian::solve(const Model& model, GoalCost& cost, const ControlBox& box,
                                     Data& data,
                                     const WarmStart& warm) {
  GddReport report;
  const auto end = [&](GddStatus status) {
    report.status = status;
    return report;
  };
  if (model.nv == 0) return report;
  const TreeMatrix& M = data.inertia.M;
  if (!data.forces.c.allFinite() || !massFactor_.compute(M)) return end(GddStatus::notFinite);

  const bool isWarm = warm.gddValid && warm.gddA.allFinite() && warm.multipliers.allFinite();
  for (int i = 0; i < model.nv; ++i) rho_[i] = options.penalty * data.weights.dof[i];
  if (isWarm) {
    a_ = warm.gddA;
    lambda_ = warm.multipliers;
  } else {
    lambda_.setZero();
    a_ = -data.forces.c;
    massFactor_.solve(a_);
  }
  rowsChanged_ = boundsChanged_ = stale_ = true;
  curvature_.setConstant(-1.0);
  evaluate(data);
  const BoundPenalty bounds{box, lambda_, rho_};

  double previous = kInfinity;  // Φ before the last step, for the same multipliers
  bool atKink = false;
  for (;;) {
    report.stationarity = gradient(cost, box, data);
    if (!std::isfinite(report.stationarity)) return end(GddStatus::notFinite);
    report.violation = box.violation(g_);
    report.objective = 0.5 * g_.dot(Rg_) + cost.value(M, a_, Ma_);
    const double merit = report.objective + penalty_;
    const double gain = previous - merit;
    const bool stalled = gain <= options.decreaseTolerance * std::max(1.0, std::abs(merit));
    const bool stationary = report.stationarity <= options.gradientTolerance;

    if (stationary || (stalled && previous < kInfinity)) {
      atKink = !stationary;
      if (report.violation <= options.violationTolerance) break;
      if (report.dualUpdates == options.maxDualUpdates) break;
      lambda_ = slope_;
      ++report.dualUpdates;
      previous = kInfinity;
      continue;
    }
    if (report.iterations == options.maxIterations) break;

    if (stale_ || boundsChanged_) {
      ++report.factorizations;
      if (!hessian_.factorize(data, massFactor_, curvature_, cost)) return end(GddStatus::notFinite);
      stale_ = boundsChanged_ = false;
    }
    direction_ = -gradient_;
    hessian_.solve(direction_);
    data.constraints.setRay(direction_);
    hessian_.multiplyP(direction_, scratch_);
    M.multiply(direction_, Md_);
    const RayResult ray =
        ray_.minimize(data.constraints, massFactor_, bounds, g_, scratch_,
                      costGradient_.dot(direction_), cost.curvatureAlong(direction_, Md_));
    ++report.iterations;
    previous = merit;
    a_ += ray.alpha * direction_;
    evaluate(data);
  }
  if (report.violation > options.violationTolerance || report.iterations == options.maxIterations)
    return end(GddStatus::iterationLimit);
  return end(atKink ? GddStatus::kink : GddStatus::converged);
}

void AugmentedLagrangian::keepWarmStart(WarmStart& warm) const {
  warm.gddA = a_;
  warm.multipliers = lambda_;
  warm.gddValid = true;
}

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/cell_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "softgauss/engine/step/inverse.hpp"

namespace softgauss::gdd {
namespace {

constexpr double kHard = 1e6;  // what is held costs so much more than the control cost
constexpr double kClose =
    1e-7;  // at a bound, at a breakpoint: relative to the terms that cancel there

}  // namespace

void CellModel::set(GoalCost& cost, const ControlLimits& limits, Data& data, const VectorX& t,
                    const VectorX& g) {
  const TreeMatrix& M = data.inertia.M;
  const Eigen::Index n = t.size();
  t_ = t;
  slope_ = cost.expansionGradient(t);

  bool changed = false;
  data.constraints.setResidual(t);
  data.constraints.evaluate(changed);
  TreeMatrix sparse;
  inverseDynamicsJacobian(data, sparse);
  P_ = sparse.dense();
  const MatrixX mass = M.dense();
  const ControlCostTerm& controlCost = cost.controlCost();
  if (controlCost.hasInverseMass())
    Q_ = P_ * data.inertia.hat().dense().llt().solve(P_);
  else
    Q_.setZero(n, n);
  // ½ c (x·g)²
  const auto addForce = [&](const VectorX& x, double c) {
    const VectorX Px = P_ * x;
    Q_ += c * Px * Px.transpose();
  };
  for (int k = 0; k < controlCost.directionCount(); ++k) addForce(controlCost.direction(k), 1.0);

  const double scale = std::max(1.0, data.forces.c.cwiseAbs().maxCoeff());
  for (Eigen::Index i = 0; i < n; ++i) {
    const double y = limits.coordinate(i, g), close = kClose * scale / limits.forcePerUnit(i);
    const bool bound = y >= limits.upper[i] - close || y <= limits.lower[i] + close;
    const double hard = bound ? kHard * data.weights.dof[i] : 0.0;
    const double single = controlCost.diagonal()[i] + (limits.isPlain(i) ? hard : 0.0);
    if (single > 0.0) Q_ += single * P_.col(i) * P_.row(i);
    if (bound && !limits.isPlain(i))
      addForce(limits.transmission->C().row(i).transpose() * limits.forcePerUnit(i), hard);
  }
  const TreeSparsity full = TreeSparsity::dense(static_cast<int>(n));
  TreeMatrix curvature;
  curvature.resize(full);
  curvature.setZero();
  curvature.add(M, cost.metricWeight());
  cost.addQuadraticCurvature(curvature);
  forces_.setCost(cost.forces());
  forces_.setJacobian(data.constraints, static_cast<int>(n));
  forces_.addCurvature(curvature);
  Q_ += curvature.dense();
  addNonsmoothRows(data.constraints, mass);
}

/// Rows at their breakpoints are held there. A ray and its reverse meet every breakpoint.
void CellModel::addNonsmoothRows(Constraints& rows, const MatrixX& mass) {
  const Eigen::Index n = t_.size();
  const Eigen::LLT<MatrixX> factor(mass);
  VectorX J(n), d(n);
  for (Eigen::Index i = 0; i < n; ++i) d[i] = std::cos(1.0 + 2.0 * static_cast<double>(i));
  crossings_.clear();
  for (const double sign : {1.0, -1.0}) {
    d *= sign;
    rows.setRay(d);
    rows.findCrossings(crossings_);
  }
  for (const Crossing& crossing : crossings_) {
    rows.breakpointGradient(crossing.breakpoint, J);
    const double size = std::max(1.0, J.cwiseAbs().dot(t_.cwiseAbs()));
    if (std::abs(rows.aboveBreakpoint(crossing.breakpoint)) > kClose * size) continue;
    const double felt = J.dot(factor.solve(J));
    if (felt > 0.0) Q_ += kHard / felt * J * J.transpose();
  }
}

const VectorX& CellModel::minimize(GoalCost& cost, const TreeMatrix& M) {
  constexpr int kMaxSteps = 50, kMaxTries = 20;
  const Eigen::Index n = t_.size();
  VectorX slope(n), d(n), next(n), down(n);
  MatrixX hessian(n, n), nextHessian(n, n);
  // q at x; −∇q and ∇²φ there.
  const auto q = [&](const VectorX& x, VectorX& descent, MatrixX& second) {
    const VectorX away = x - t_, pull = Q_ * away;
    const double phi = cost.functions(x, slope, second);
    descent = slope_ - slope - pull;
    return phi - slope_.dot(away) + 0.5 * away.dot(pull);
  };
  x_ = t_;
  double value = q(x_, down, hessian);
  VectorX nextDown(n);
  for (int i = 0; i < kMaxSteps && std::isfinite(value); ++i) {
    Eigen::LLT<MatrixX> factor(Q_ + hessian);
    if (factor.info() != Eigen::Success) {
      cost.raiseCurvature(M, hessian);
      factor.compute(Q_ + hessian);
    }
    d = factor.solve(down);
    const double predicted = down.dot(d);
    if (!(predicted > 1e-15 * std::abs(value))) break;
    // Where the slope along d ends: a root between lo and hi, by secants kept inside.
    double alpha = 1.0, lo = 0.0, hi = kInfinity, slopeLo = -predicted, slopeHi = 0.0,
           found = value;
    bool falls = false;
    for (int k = 0; k < kMaxTries; ++k) {
      next = x_ + alpha * d;
      found = q(next, nextDown, nextHessian);
      const double along = -nextDown.dot(d);
      falls = found <= value - 1e-4 * alpha * predicted;
      if (falls && std::abs(along) <= 0.2 * predicted) break;
      if (falls && along < 0.0) {
        if (alpha >= 1.0) break;
        lo = alpha, slopeLo = along;
      } else {
        hi = alpha, slopeHi = along;
      }
      const double share = slopeHi > 0.0 ? slopeLo / (slopeLo - slopeHi) : 0.5;
      alpha = lo + std::clamp(share, 0.1, 0.9) * (hi - lo);
    }
    if (!falls) break;
    x_ = next;
    value = found;
    down.swap(nextDown);
    hessian.swap(nextHessian);
  }
  return x_;
}

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "softgauss/engine/step/data.hpp"

namespace softgauss::test {

/// The objective of (1.1) by M, J and P = M + Jᵀ∇²s J, factored as a whole: what judges the one on
/// bodies, with which it shares rows and Newton's method.
class GaussObjective {
 public:
  explicit GaussObjective(Data& data)
      : M_(data.inertia.hat()), net_(data.forces.net), rows_(data.constraints) {
    for (VectorX* x : {&a_, &Ma_, &Md_}) *x = VectorX::Zero(net_.size());
    scale_ = data.inertia.forceScale;
    unit_ = std::max(1.0, net_.cwiseProduct(scale_).cwiseAbs().maxCoeff());
    scale_ /= unit_;
  }

  const VectorX& a() const { return a_; }

  double moveTo(const VectorX& a) {
    a_ = a;
    M_.multiply(a_, Ma_);
    rows_.setResidual(a_);
    return 0.5 * a_.dot(Ma_) - a_.dot(net_) + rows_.evaluate(changed_);
  }

  double gradient(VectorX& g) {
    rows_.evaluate(changed_);
    g = net_ - Ma_;
    rows_.addForce(g);
    g = -g;
    return g.cwiseProduct(scale_).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  }

  bool cellChanged() const { return changed_; }

  bool factorize() {
    changed_ = false;
    newFactor_ = true;
    P_.resize(rows_.sparsity());
    P_.assign(M_);
    rows_.addCurvature(P_);
    return factor_.compute(P_);
  }

  double direction(const VectorX& g, VectorX& d) {
    d = -g;
    factor_.solve(d);
    M_.multiply(d, Md_);
    rows_.setRay(d);
    slope_ = d.dot(Ma_) - d.dot(net_);
    curvature_ = d.dot(Md_);
    return g.dot(d);
  }

  double unit() const { return unit_; }
  bool staysInCell() const { return newFactor_ && rows_.staysInCell(); }

  Jet along(double alpha) const {
    Jet jet{0.0, slope_ + alpha * curvature_, curvature_};
    rows_.along(alpha, jet);
    return jet;
  }

  void advance(const VectorX& d, double alpha) {
    a_ += alpha * d;
    Ma_ += alpha * Md_;
    rows_.advance(alpha);
    newFactor_ = false;
  }

 private:
  const TreeMatrix& M_;
  const VectorX& net_;
  Constraints& rows_;
  VectorX a_, Ma_, Md_, scale_;
  TreeMatrix P_;
  TreeFactor factor_;
  bool changed_ = true;
  bool newFactor_ = false;  ///< no step has been taken with it
  double unit_ = 1.0, slope_ = 0.0, curvature_ = 0.0;
};
static_assert(NewtonObjective<GaussObjective>);

/// a that minimises (1.1), from M̂⁻¹(τ − c), and how its search ended.
inline NewtonReport minimizeGauss(const Model& model, Data& data, VectorX& a) {
  GaussObjective objective(data);
  TreeFactor mass;
  mass.compute(data.inertia.hat());
  VectorX start = data.forces.net, gradient(model.nv), direction(model.nv);
  mass.solve(start);
  objective.moveTo(start);
  const double residual = objective.gradient(gradient);
  const NewtonReport report = minimize(objective, model.options.tolerance,
                                       model.options.maxIterations, residual, gradient, direction);
  a = objective.a();
  return report;
}

}  // namespace softgauss::test

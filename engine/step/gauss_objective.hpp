// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// The objective of (1.1) by M, J and P, for goals; body_objective.hpp needs none of them.
class GaussObjective {
 public:
  /// `net`: τ − c, and what else is constant.
  GaussObjective(const MassMatrix& inertia, const VectorX& net, Constraints& rows,
                 ForwardSolution& solution)
      : M_(inertia.hat()), net_(net), rows_(rows), s_(solution) {
    // The largest of the smooth forces, in their common unit, sets the scale.
    s_.scale = inertia.forceScale;
    const double largest = std::max(1.0, net_.cwiseProduct(s_.scale).cwiseAbs().maxCoeff());
    s_.scale /= largest;
  }

  /// Moves to a; returns the cost.
  double moveTo(const VectorX& a) {
    s_.a = a;
    M_.multiply(s_.a, s_.Ma);
    rows_.setResidual(s_.a);
    const double cost = rows_.evaluate(changed_);
    fresh_ = true;
    return 0.5 * s_.a.dot(s_.Ma) - s_.a.dot(net_) + cost;
  }

  double gradient(VectorX& g) {
    if (!fresh_) rows_.evaluate(changed_);
    fresh_ = false;
    // −g = τ − c − M a + Jᵀf
    g = net_ - s_.Ma;
    rows_.addForce(g);
    g = -g;
    return g.cwiseProduct(s_.scale).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  }

  bool cellChanged() const { return changed_; }

  bool factorize() {
    changed_ = false;
    newFactor_ = true;
    s_.P.resize(rows_.sparsity());
    s_.P.assign(M_);
    rows_.addCurvature(s_.P);
    return s_.factor.compute(s_.P);
  }

  void direction(const VectorX& g, VectorX& d) {
    d = -g;
    s_.factor.solve(d);
    M_.multiply(d, s_.Md);
    rows_.setRay(d);
    // Along the ray the smooth part has slope dᵀ(M a − net) + α dᵀM d.
    slope_ = d.dot(s_.Ma) - d.dot(net_);
    curvature_ = d.dot(s_.Md);
  }

  /// Of the first step with a factor. What rounding has left of it is found with a search: where
  /// rows are very stiff, that gains more than whole steps do.
  bool staysInCell() const { return newFactor_ && rows_.staysInCell(); }

  Jet along(double alpha) const {
    Jet jet{0.0, slope_ + alpha * curvature_, curvature_};
    rows_.along(alpha, jet);
    return jet;
  }

  void advance(const VectorX& d, double alpha) {
    s_.a += alpha * d;
    s_.Ma += alpha * s_.Md;
    rows_.advance(alpha);
    newFactor_ = false;
  }

 private:
  const TreeMatrix& M_;
  const VectorX& net_;
  Constraints& rows_;
  ForwardSolution& s_;
  bool changed_ = true;
  bool fresh_ = false;
  bool newFactor_ = false;  ///< no step has been taken with it
  double slope_ = 0.0, curvature_ = 0.0;
};
static_assert(NewtonObjective<GaussObjective>);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "engine/step/forward.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss {
namespace {

/// The objective of (T.1) as the Newton solver sees it.
class GaussObjective {
 public:
  explicit GaussObjective(Data& data)
      : M_(data.inertia.M),
        net_(data.forces.net),
        constraints_(data.constraints),
        s_(data.forward) {
    // The largest of the smooth forces, in their common unit, sets the scale.
    s_.scale = data.inertia.forceScale;
    const double largest = std::max(1.0, net_.cwiseProduct(s_.scale).cwiseAbs().maxCoeff());
    s_.scale /= largest;
  }

  /// Moves to a; returns the cost.
  double moveTo(const VectorX& a) {
    s_.a = a;
    M_.multiply(s_.a, s_.Ma);
    constraints_.setResidual(s_.a);
    const double rows = constraints_.evaluate(changed_);
    fresh_ = true;
    return 0.5 * s_.a.dot(s_.Ma) - s_.a.dot(net_) + rows;
  }

  double gradient(VectorX& g) {
    if (!fresh_) constraints_.evaluate(changed_);
    fresh_ = false;
    // −g = τ − c − M a + Jᵀf
    g = net_ - s_.Ma;
    constraints_.addForce(g);
    g = -g;
    return g.cwiseProduct(s_.scale).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  }

  bool cellChanged() const { return changed_; }

  bool factorize() {
    changed_ = false;
    s_.P.resize(constraints_.sparsity());
    s_.P.assign(M_);
    constraints_.addCurvature(s_.P);
    return s_.factor.compute(s_.P);
  }

  void direction(const VectorX& g, VectorX& d) {
    d = -g;
    s_.factor.solve(d);
    M_.multiply(d, s_.Md);
    constraints_.setRay(d);
    // Along the ray the smooth part has slope dᵀ(M a − net) + α dᵀM d.
    slope_ = d.dot(s_.Ma) - d.dot(net_);
    curvature_ = d.dot(s_.Md);
  }

  Jet along(double alpha) const {
    Jet jet{0.0, slope_ + alpha * curvature_, curvature_};
    constraints_.along(alpha, jet);
    return jet;
  }

  void advance(const VectorX& d, double alpha) {
    s_.a += alpha * d;
    s_.Ma += alpha * s_.Md;
    constraints_.advance(alpha);
  }

 private:
  const TreeMatrix& M_;
  const VectorX& net_;
  Constraints& constraints_;
  ForwardSolution& s_;
  bool changed_ = true;
  bool fresh_ = false;
  double slope_ = 0.0, curvature_ = 0.0;
};
static_assert(NewtonObjective<GaussObjective>);

int firstNotFinite(const VectorX& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i)
    if (!std::isfinite(x[i])) return static_cast<int>(i);
  return -1;
}

}  // namespace

SolveStatus forwardDynamics(const Model& model, const VectorX* guess, Data& data) noexcept {
  ForwardSolution& s = data.forward;
  s.report = {};
  if (model.nv == 0) return SolveStatus::converged;
  const auto notFinite = [&] {
    data.stats.badDof = firstNotFinite(data.forces.net);
    s.report.status = SolveStatus::notFinite;
    return s.report.status;
  };
  if (!data.forces.net.allFinite()) return notFinite();

  GaussObjective objective(data);
  // A warm start that solves the problem already (after GDD, at rest) ends it here.
  const bool warm = data.constraints.rowCount() > 0 && guess && guess->allFinite();
  double warmCost = kInfinity;
  if (warm) {
    warmCost = objective.moveTo(*guess);
    s.report.residual = objective.gradient(s.gradient);
    if (s.report.residual <= model.options.tolerance) return s.report.status;
  }
  // Without rows the minimiser is M⁻¹(τ − c).
  if (!s.massFactor.compute(data.inertia.M)) {
    notFinite();
    data.stats.badDof = s.massFactor.failedRow();
    return s.report.status;
  }
  s.start = data.forces.net;
  s.massFactor.solve(s.start);
  const double smoothCost = objective.moveTo(s.start);
  if (warm && warmCost <= smoothCost) objective.moveTo(*guess);
  s.report = minimize(objective, model.options.tolerance, model.options.maxIterations, s.gradient,
                      s.direction);
  if (s.report.status == SolveStatus::notFinite) data.stats.badDof = firstNotFinite(s.a);
  return s.report.status;
}

}  // namespace softgauss

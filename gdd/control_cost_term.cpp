// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/control_cost_term.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/segment_vectors.hpp"

namespace softgauss::gdd {
namespace {

[[noreturn]] void fail(const std::string& problem) {
  throw ModelError({}, "metric of force", problem);
}

}  // namespace

ForceMetric ForceMetric::diagonal(const VectorX& r) {
  ForceMetric metric;
  metric.setDiagonal(r);
  return metric;
}

void ForceMetric::setDiagonal(const VectorX& r) {
  for (Eigen::Index i = 0; i < r.size(); ++i)
    if (!(r[i] > 0.0) || !std::isfinite(r[i]))
      fail("entry " + std::to_string(i) + " is " + std::to_string(r[i]) +
           ", expected a finite number above 0");
  dofs_ = static_cast<int>(r.size());
  diagonal_ = r;
  root_.resize(0, 0);
}

ForceMetric ForceMetric::dense(const MatrixX& R) {
  constexpr double kSymmetric = 1e-12;  // relative to the diagonal: what rounding may do
  if (R.rows() != R.cols())
    fail("found " + std::to_string(R.rows()) + " × " + std::to_string(R.cols()) +
         " entries, expected a square matrix");
  if (!R.allFinite()) fail("has an entry that is not finite");
  for (Eigen::Index i = 0; i < R.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (std::abs(R(i, j) - R(j, i)) > kSymmetric * std::sqrt(std::abs(R(i, i) * R(j, j))))
        fail("entries (" + std::to_string(i) + ", " + std::to_string(j) +
             ") and its mirror differ, expected a symmetric matrix");
  const Eigen::LLT<MatrixX> factor(R);
  if (factor.info() != Eigen::Success) fail("is not positive definite");
  ForceMetric metric;
  metric.dofs_ = static_cast<int>(R.rows());
  metric.root_ = factor.matrixL();
  return metric;
}

void ControlCostTerm::set(const ForceMetric& R) {
  SOFTGAUSS_ASSERT(R.isInverseMass() || R.dofs() == diagonal_.size());
  inverseMass_ = R.isInverseMass();
  metric_ = R.entries();
  if (metric_.size() > 0)
    diagonal_ = metric_;
  else
    diagonal_.setZero();
  count_ = 0;
  hasFree_ = false;
  freeCost_ = 0.0;
  for (Eigen::Index k = 0; k < R.root().cols(); ++k) add(R.root().col(k), 1.0);
  metricDirections_ = count_;
}

void ControlCostTerm::setFree(const VectorX& force) {
  SOFTGAUSS_ASSERT(force.size() == diagonal_.size());
  hasFree_ = true;
  free_ = force;
  freeSlope_.resize(force.size());  // copies keep their memory
  scratch_.resize(force.size());
  if (metric_.size() > 0)
    freeExplicit_ = metric_.cwiseProduct(force);
  else
    freeExplicit_.setZero(force.size());
  for (int k = 0; k < metricDirections_; ++k)
    freeExplicit_ += direction(k).dot(force) * direction(k);
}

void ControlCostTerm::prepare(const TreeFactor& massFactor) {
  if (!hasFree_) return;
  const Segments dofs = massFactor.dofs();
  copyOnly(dofs, freeExplicit_, freeSlope_);
  if (inverseMass_) {
    copyOnly(dofs, free_, scratch_);
    massFactor.solve(scratch_);
    freeSlope_ += scratch_;
  }
  freeCost_ = 0.5 * dot(dofs, free_, freeSlope_);
}

void ControlCostTerm::add(const Eigen::Ref<const VectorX>& c, double weight) {
  SOFTGAUSS_ASSERT(c.size() == diagonal_.size() && weight >= 0.0);
  if (directions_.cols() == count_) directions_.conservativeResize(c.size(), 2 * count_ + 1);
  directions_.col(count_++) = std::sqrt(weight) * c;
}

void ControlCostTerm::appendPairs(const Model& model,
                                  std::vector<std::pair<int, int>>& pairs) const {
  for (int k = 0; k < count_; ++k) appendCoupledTrees(model, directions_.col(k), pairs);
}

MatrixX ControlCostTerm::dense() const {
  MatrixX R = diagonal_.asDiagonal();
  R.noalias() += directions_.leftCols(count_) * directions_.leftCols(count_).transpose();
  return R;
}

void ControlCostTerm::multiply(const TreeFactor& massFactor, const VectorX& x, VectorX& Rx) const {
  if (inverseMass_) {
    Rx = x;
    massFactor.solve(Rx);
    Rx += diagonal_.cwiseProduct(x);
  } else {
    Rx = diagonal_.cwiseProduct(x);
  }
  for (int k = 0; k < count_; ++k) Rx += direction(k).dot(x) * direction(k);
}

}  // namespace softgauss::gdd

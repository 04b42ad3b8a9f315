// SPDX-License-Identifier: Apache-2.0
#include "gdd/cost.hpp"

#include "engine/core/vector_clones.hpp"

namespace softgauss::gdd {
namespace {

/// K ← K + scale · YᵀY, lower triangle: column i of K gains scale · Σ_k Y_ki Y_k,i…
SOFTGAUSS_VECTOR_CLONES void addGram(const RowMajorMatrixX& Y, double scale, MatrixX& K) {
  const int rows = static_cast<int>(Y.rows()), n = static_cast<int>(Y.cols());
  for (int i = 0; i < n; ++i) {
    double* column = K.data() + i * n;
    int k = 0;
    for (; k + 4 <= rows; k += 4) {
      const double *y0 = Y.data() + k * n, *y1 = y0 + n, *y2 = y1 + n, *y3 = y2 + n;
      const double s0 = scale * y0[i], s1 = scale * y1[i], s2 = scale * y2[i], s3 = scale * y3[i];
      for (int j = i; j < n; ++j) column[j] += s0 * y0[j] + s1 * y1[j] + s2 * y2[j] + s3 * y3[j];
    }
    for (; k < rows; ++k) {
      const double* y = Y.data() + k * n;
      const double s = scale * y[i];
      for (int j = i; j < n; ++j) column[j] += s * y[j];
    }
  }
}

}  // namespace

void GoalCost::clear() {
  rows_.clear();
  weight_.clear();
  target_.clear();
  metricWeight_ = 0.0;
  metricOffset_.setZero();
}

void GoalCost::addPoint(const Model& model, const Kinematics& k, const TreeSparsity& tree, int body,
                        const Vector3& p_WP, double weight, const Vector3& target) {
  RelativeMotion motion;  // against the world
  motion.bodyB = body;
  motion.p_WA = motion.p_WB = p_WP;
  motion.linearDim = 3;
  rows_.add(model, k, tree, motion);
  weight_.push_back(weight);
  target_.push_back(target);
}

void GoalCost::addMetric(double weight, const VectorX& target) {
  metricWeight_ += weight;
  metricOffset_ -= weight * target;
}

double GoalCost::value(const TreeMatrix& M, const VectorX& a, const VectorX& Ma) const {
  double sum = 0.0;
  for (int i = 0; i < rows_.size(); ++i) {
    Vector3 y;
    rows_.multiply(i, a, y.data());
    sum += 0.5 * weight_[i] * (y - target_[i]).squaredNorm();
  }
  if (metricWeight_ != 0.0) {
    M.multiply(metricOffset_, scratch_);
    sum += 0.5 * metricWeight_ * a.dot(Ma) + a.dot(scratch_);
  }
  return sum;
}

void GoalCost::gradient(const TreeMatrix& M, const VectorX& a, const VectorX& Ma,
                        VectorX& g) const {
  if (metricWeight_ != 0.0) {
    M.multiply(metricOffset_, scratch_);
    g = metricWeight_ * Ma + scratch_;
  } else {
    g.setZero();
  }
  for (int i = 0; i < rows_.size(); ++i) {
    Vector3 y;
    rows_.multiply(i, a, y.data());
    const Vector3 slope = weight_[i] * (y - target_[i]);
    rows_.addTransposed(i, slope.data(), g);
  }
}

double GoalCost::curvatureAlong(const VectorX& d, const VectorX& Md) const {
  double sum = metricWeight_ * d.dot(Md);
  for (int i = 0; i < rows_.size(); ++i) {
    Vector3 y;
    rows_.multiply(i, d, y.data());
    sum += weight_[i] * y.squaredNorm();
  }
  return sum;
}

void GoalCost::addRowCurvature(TreeMatrix& H) {
  for (int i = 0; i < rows_.size(); ++i) {
    const double w = weight_[i];
    const double diagonal[9] = {w, 0, 0, 0, w, 0, 0, 0, w};
    rows_.addCurvature(i, diagonal, H);
  }
}

void GoalCost::addReducedCurvature(const TreeFactor& massFactor, const RowMajorMatrixX& S,
                                   RowMajorMatrixX& rootS, MatrixX& K) const {
  if (metricWeight_ != 0.0) {
    massFactor.multiplyRoot(S, rootS);
    addGram(rootS, metricWeight_, K);
  }
  // One rank for each row of J.
  reduced_.resize(S.cols());
  for (int i = 0; i < rows_.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const double unit[3] = {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
      scratch_.setZero();
      rows_.addTransposed(i, unit, scratch_);
      reduced_.setZero();
      for (Eigen::Index j = 0; j < scratch_.size(); ++j)
        if (scratch_[j] != 0.0) reduced_ += scratch_[j] * S.row(j).transpose();
      K.selfadjointView<Eigen::Lower>().rankUpdate(reduced_, weight_[i]);
    }
  }
}

}  // namespace softgauss::gdd

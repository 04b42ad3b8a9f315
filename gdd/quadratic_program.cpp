// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/quadratic_program.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/vector_clones.hpp"
#include "softgauss/engine/core/vector_kernels.hpp"
#include "softgauss/gdd/weighted_rows.hpp"

namespace softgauss::gdd {
namespace {

/// Of the bound, and of the largest p on the way: what rounding may violate.
constexpr double kFeasible = 1e-12;
/// A normal of which less than this share (squared) is new depends on the active ones.
constexpr double kDependentRow = 1e-18;

/// X ← L⁻ᵀ, upper triangular, by columns; X must be zero.
SOFTGAUSS_VECTOR_CLONES void invertTransposed(const double* L, int n, int stride,
                                              const double* inverse, double* X) {
  for (int j = 0; j < n; ++j) {
    double* column = X + j * stride;
    column[j] = 1.0;
    addCombination(-1.0, L + j, stride, X, stride, j, paddedSize(j), column);
    for (int i = 0; i <= j; ++i) column[i] *= inverse[j];
  }
}

/// J ← J − z cᵀ for `count` columns.
SOFTGAUSS_VECTOR_CLONES void subtractOuter(const double* z, const double* c, int count, int stride,
                                           double* J) {
  for (int k = 0; k < count; ++k) addScaled(-c[k], z, stride, J + k * stride);
}

}  // namespace

void QuadraticProgram::reserve(int unknowns, int rows) {
  const std::size_t most = static_cast<std::size_t>(2 * unknowns + rows);
  face_.reserve(unknowns, rows);
  active_.reserve(most);
  isActive_.reserve(most);
  multiplier_.reserve(most);
  for (std::vector<double>* list : {&norm_, &rowMultipliers_})
    list->reserve(static_cast<std::size_t>(rows));
  J_.resize(paddedSize(unknowns), unknowns);
  R_.resize(unknowns, unknowns);
  d_.resize(unknowns);
  r_.resize(unknowns);
  z_.resize(paddedSize(unknowns));
}

double QuadraticProgram::slack(int constraint) const {
  const int n = static_cast<int>(p_.size());
  if (constraint < n) return p_[constraint] - (*program_.lower)[constraint];
  if (constraint < 2 * n) return (*program_.upper)[constraint - n] - p_[constraint - n];
  const int k = constraint - 2 * n;
  return program_.N->row(k).dot(p_) + (*program_.distance)[k];
}

QuadraticProgram::Violation QuadraticProgram::mostViolated() const {
  Violation most;
  const int n = static_cast<int>(p_.size());
  const auto consider = [&](int constraint, double amount, double tolerance) {
    if (amount > std::max(most.amount, tolerance) && !isActive_[constraint])
      most = {constraint, amount};
  };
  for (int i = 0; i < n; ++i) {
    const double lower = (*program_.lower)[i], upper = (*program_.upper)[i];
    consider(i, lower - p_[i], kFeasible * std::max(size_, std::abs(lower)));
    consider(n + i, p_[i] - upper, kFeasible * std::max(size_, std::abs(upper)));
  }
  for (int k = 0; k < program_.rows; ++k)
    if (norm_[k] > 0.0)
      consider(2 * n + k, -(program_.N->row(k).dot(p_) + (*program_.distance)[k]) / norm_[k],
               kFeasible * size_);
  return most;
}

void QuadraticProgram::rotatedNormal(int constraint) {
  const int n = static_cast<int>(p_.size());
  if (constraint < n)
    d_ = J_.row(constraint).transpose();
  else if (constraint < 2 * n)
    d_ = -J_.row(constraint - n).transpose();
  else
    d_.noalias() = J_.topRows(n).transpose() * program_.N->row(constraint - 2 * n).transpose();
}

void QuadraticProgram::add(int constraint, double multiplier) {
  // Reflect the columns of J behind the active ones, J₂ ← J₂ (1 − 2 vvᵀ/vᵀv), so that of d = J₂ᵀn
  // one entry is left. z = J₂ d is known.
  const int n = static_cast<int>(p_.size()), m = static_cast<int>(active_.size());
  const int stride = paddedSize(n);
  const double length = d_.tail(n - m).norm();
  const double left = d_[m] > 0.0 ? -length : length;
  if (n - m > 1) {
    z_ -= left * J_.col(m);  // J₂ v, v = d − left e₁
    d_[m] -= left;
    z_ /= length * std::abs(d_[m]);  // vᵀv = 2 length |v₁|
    subtractOuter(z_.data(), d_.data() + m, n - m, stride, J_.data() + m * stride);
    d_[m] = left;
  }
  R_.col(m).head(m + 1) = d_.head(m + 1);
  active_.push_back(constraint);
  multiplier_.push_back(multiplier);
  isActive_[constraint] = 1;
}

void QuadraticProgram::drop(int place) {
  const int n = static_cast<int>(p_.size()), m = static_cast<int>(active_.size());
  isActive_[active_[place]] = 0;
  active_.erase(active_.begin() + place);
  multiplier_.erase(multiplier_.begin() + place);
  for (int i = place; i + 1 < m; ++i) R_.col(i).head(i + 2) = R_.col(i + 1).head(i + 2);
  // R is upper triangular but for one entry below the diagonal in each column from `place` on.
  for (int i = place; i + 1 < m; ++i) {
    const double a = R_(i, i), b = R_(i + 1, i), h = std::sqrt(a * a + b * b);
    if (h == 0.0) continue;
    const double c = a / h, s = b / h;
    for (int k = i; k + 1 < m; ++k) {
      const double x = R_(i, k), y = R_(i + 1, k);
      R_(i, k) = c * x + s * y;
      R_(i + 1, k) = c * y - s * x;
    }
    for (int k = 0; k < n; ++k) {
      const double x = J_(k, i), y = J_(k, i + 1);
      J_(k, i) = c * x + s * y;
      J_(k, i + 1) = c * y - s * x;
    }
  }
}

bool QuadraticProgram::minimize(const VectorX& q, const VectorX& lower, const VectorX& upper,
                                const RowMajorMatrixX& N, const VectorX& distance, int rows) {
  program_ = {&q, &lower, &upper, &N, &distance, rows};
  const int n = static_cast<int>(q.size());
  bool solved = face_.minimize(factor_, program_);
  if (solved) {
    p_ = Eigen::Map<const VectorX>(face_.solution().data(), n);
    active_ = face_.active();
    multiplier_ = face_.multipliers();
  } else {
    solved = minimizeByDual(program_);
  }
  boundMultipliers_.setZero(n);
  rowMultipliers_.assign(static_cast<std::size_t>(rows), 0.0);
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const int c = active_[k];
    const double multiplier = std::max(0.0, multiplier_[k]);
    if (c < n)
      boundMultipliers_[c] = multiplier, p_[c] = lower[c];
    else if (c < 2 * n)
      boundMultipliers_[c - n] = -multiplier, p_[c - n] = upper[c - n];
    else
      rowMultipliers_[c - 2 * n] = multiplier;
  }
  p_ = p_.cwiseMax(lower).cwiseMin(upper);
  // −(½ pᵀKp + qᵀp), with Kp = −q + Aᵀν and νᵀA p = νᵀb: one product less, and no cancellation.
  decrease_ = -0.5 * q.dot(p_) - 0.5 * boundMultipliers_.dot(p_);
  for (int k = 0; k < rows; ++k) decrease_ += 0.5 * rowMultipliers_[k] * distance[k];
  decrease_ = std::max(0.0, decrease_);
  return solved;
}

double QuadraticProgram::predictedDecrease(const VectorX& q) const {
  const int n = factor_.size();
  scratch_.assign(static_cast<std::size_t>(factor_.stride()), 0.0);
  Eigen::Map<VectorX> left(scratch_.data(), n);  // ρ, then L⁻¹ρ
  left = q - boundMultipliers_;
  for (int k = 0; k < program_.rows; ++k)
    if (rowMultipliers_[k] > 0.0) left -= rowMultipliers_[k] * program_.N->row(k).transpose();
  factor_.solveLower(scratch_.data());
  return 0.5 * left.squaredNorm();
}

bool QuadraticProgram::minimizeByDual(const ProgramData& program) {
  const VectorX& q = *program.q;
  const RowMajorMatrixX& N = *program.N;
  const int n = static_cast<int>(q.size()), rows = program.rows;
  scratch_.assign(static_cast<std::size_t>(factor_.stride()), 0.0);
  Eigen::Map<VectorX>(scratch_.data(), n) = -q;
  factor_.solveLower(scratch_.data());
  factor_.solveTransposed(scratch_.data());
  p_ = Eigen::Map<VectorX>(scratch_.data(), n);
  size_ = p_.norm();
  active_.clear();
  multiplier_.clear();
  isActive_.assign(static_cast<std::size_t>(2 * n + rows), 0);
  norm_.resize(static_cast<std::size_t>(rows));
  for (int k = 0; k < rows; ++k) norm_[k] = N.row(k).norm();
  bool rotated = false, solved = true;

  for (int changes = 0; solved;) {
    const Violation violation = mostViolated();
    if (violation.constraint < 0) break;
    const int entering = violation.constraint;
    if (!rotated) {
      J_.setZero(paddedSize(n), n);
      invertTransposed(factor_.L(), n, paddedSize(n), factor_.inverse(), J_.data());
      R_.resize(n, n);
      rotated = true;
    }
    double enteringMultiplier = 0.0;
    for (;;) {
      if (++changes > 20 * (n + rows)) {
        solved = false;
        break;
      }
      const int m = static_cast<int>(active_.size());
      rotatedNormal(entering);
      // Direction in p, and the rate of the active multipliers.
      const double fresh = d_.tail(n - m).squaredNorm();
      const bool dependent = !(fresh > kDependentRow * d_.squaredNorm());
      r_ = d_;
      for (int k = m - 1; k >= 0; --k) {  // r ← R⁻¹d over the active ones
        r_[k] /= R_(k, k);
        r_.head(k) -= r_[k] * R_.col(k).head(k);
      }
      double dual = kInfinity;
      int leaving = -1;
      for (int k = 0; k < m; ++k) {
        if (!(r_[k] > 0.0) || multiplier_[k] / r_[k] >= dual) continue;
        dual = multiplier_[k] / r_[k];
        leaving = k;
      }
      const double primal = dependent ? kInfinity : -slack(entering) / fresh;
      const double step = std::min(primal, dual);
      if (!std::isfinite(step)) {  // infeasible, which p = 0 says it is not: rounding
        solved = false;
        break;
      }
      if (!dependent) {
        z_.setZero(J_.rows());
        addWeightedRows(d_.data() + m, J_.col(m).data(), n - m, paddedSize(n), z_.data());
        p_ += step * z_.head(n);
        size_ = std::max(size_, p_.norm());
      }
      for (int k = 0; k < m; ++k) multiplier_[k] -= step * r_[k];
      enteringMultiplier += step;
      if (primal <= dual) {
        add(entering, enteringMultiplier);
        break;
      }
      drop(leaving);
    }
  }
  return solved;
}

}  // namespace softgauss::gdd

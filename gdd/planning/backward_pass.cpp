// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/backward_pass.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::planning {

void ValueModel::mirror() {
  for (Eigen::Index j = 1; j < slope.size(); ++j)
    for (Eigen::Index i = 0; i < j; ++i) curvature(i, j) = curvature(j, i);
}

BoxProgram::BoxProgram(int m)
    : L_(MatrixX::Zero(m, m)),
      gradient_(VectorX::Zero(m)),
      step_(gradient_),
      trial_(gradient_),
      Hx_(gradient_) {
  free_.reserve(static_cast<std::size_t>(m));
  factored_.reserve(static_cast<std::size_t>(m));
}

double BoxProgram::valueAt(const MatrixX& H, const VectorX& g, const VectorX& x) {
  Hx_.noalias() = H * x;
  return 0.5 * x.dot(Hx_) + g.dot(x);
}

/// L L^T of H on what is free, in place.
bool BoxProgram::factorize(const MatrixX& H) {
  const auto f = static_cast<Eigen::Index>(free_.size());
  for (Eigen::Index i = 0; i < f; ++i)
    for (Eigen::Index j = 0; j <= i; ++j)
      L_(i, j) = H(free_[static_cast<std::size_t>(i)], free_[static_cast<std::size_t>(j)]);
  for (Eigen::Index j = 0; j < f; ++j) {
    const double pivot = L_(j, j) - L_.row(j).head(j).squaredNorm();
    if (!(pivot > 0.0)) return false;
    L_(j, j) = std::sqrt(pivot);
    for (Eigen::Index i = j + 1; i < f; ++i)
      L_(i, j) = (L_(i, j) - L_.row(i).head(j).dot(L_.row(j).head(j))) / L_(j, j);
  }
  factored_ = free_;
  return true;
}

bool BoxProgram::solve(const MatrixX& H, const VectorX& g, const VectorX& lower,
                       const VectorX& upper, VectorX& x) {
  constexpr int kIterations = 50, kHalvings = 30;
  const auto m = static_cast<int>(g.size());
  x = x.cwiseMax(lower).cwiseMin(upper);
  bool hasFactor = false;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    gradient_.noalias() = H * x;
    gradient_ += g;
    free_.clear();
    for (int i = 0; i < m; ++i)
      if (!((x[i] <= lower[i] && gradient_[i] > 0.0) || (x[i] >= upper[i] && gradient_[i] < 0.0)))
        free_.push_back(i);
    if (free_.empty()) return true;
    if (!hasFactor || free_ != factored_) {
      if (!factorize(H)) return false;
      hasFactor = true;
    }
    const auto f = static_cast<Eigen::Index>(free_.size());
    double largest = 0.0;
    for (Eigen::Index i = 0; i < f; ++i) {
      step_[i] = gradient_[free_[static_cast<std::size_t>(i)]];
      largest = std::max(largest, std::abs(step_[i]));
    }
    // Rounding of H x.
    if (largest <= 1e-12 * (1.0 + g.cwiseAbs().maxCoeff())) return true;
    const auto L = L_.topLeftCorner(f, f).triangularView<Eigen::Lower>();
    auto step = step_.head(f);
    L.solveInPlace(step);
    L.transpose().solveInPlace(step);
    const double before = valueAt(H, g, x);
    bool moved = false;
    double length = 1.0;
    for (int halving = 0; halving < kHalvings && !moved; ++halving, length *= 0.5) {
      trial_ = x;
      for (Eigen::Index i = 0; i < f; ++i)
        trial_[free_[static_cast<std::size_t>(i)]] -= length * step_[i];
      trial_ = trial_.cwiseMax(lower).cwiseMin(upper);
      moved = valueAt(H, g, trial_) < before;
    }
    if (!moved) return true;  // rounding has the last word
    x = trial_;
  }
  return true;
}

void BoxProgram::gain(const MatrixX& X, MatrixX& K) {
  K.setZero();
  if (free_.empty()) return;
  const auto f = static_cast<Eigen::Index>(free_.size());
  if (rows_.rows() < K.rows() || rows_.cols() != K.cols()) rows_.resize(K.rows(), K.cols());
  for (Eigen::Index i = 0; i < f; ++i) rows_.row(i) = -X.row(free_[static_cast<std::size_t>(i)]);
  const auto L = L_.topLeftCorner(f, f).triangularView<Eigen::Lower>();
  auto rows = rows_.topRows(f);
  L.solveInPlace(rows);
  L.transpose().solveInPlace(rows);
  for (Eigen::Index i = 0; i < f; ++i) K.row(free_[static_cast<std::size_t>(i)]) = rows_.row(i);
}

BackwardPass::BackwardPass(const Model& model, std::vector<int> controlled)
    : n_(model.nv),
      controlled_(std::move(controlled)),
      overA_(n_, 2 * n_),
      overU_(static_cast<int>(controlled_.size()), 2 * n_),
      raised_(VectorX::Zero(n_)),
      dynamics_(n_, paddedSize(n_) + overU_.columnsOfX() + static_cast<int>(controlled_.size())),
      solved_(dynamics_),
      weighed_(n_, dynamics_.stride() - paddedSize(n_)),
      half_(n_, overU_.columnsOfX()),
      box_(static_cast<int>(controlled_.size())) {
  const int n = n_, m = static_cast<int>(controlled_.size());
  for (MatrixX* X : {&VA_, &Qxx_, &KQK_}) *X = MatrixX::Zero(2 * n, 2 * n);
  for (MatrixX* X : {&VB_, &Qxa_}) *X = MatrixX::Zero(2 * n, n);
  Qaa_ = MatrixX::Zero(n, n);
  Qa_ = VectorX::Zero(n);
  for (VectorX* x : {&Qx_, &Av_}) *x = VectorX::Zero(2 * n);
  Quu_ = raisedControls_ = MatrixX::Zero(m, m);
  Qux_ = QK_ = MatrixX::Zero(m, 2 * n);
  lower_ = upper_ = Qk_ = VectorX::Zero(m);
}

void BackwardPass::withoutForces(const Knot& knot, const ValueModel& next,
                                 const ValueModel& state) {
  const Transition& T = knot.transition;
  T.multiply(next.curvature, VA_, VB_);
  T.multiplyByATransposed(VA_, Qxx_);
  T.multiplyByATransposed(VB_, Qxa_);
  T.multiplyByBTransposed(VB_, Qaa_);
  Qxx_ += state.curvature;
  T.multiplyByATransposed(next.slope, Av_);
  T.multiplyByBTransposed(next.slope, Qa_);
  Qx_ = state.slope + Av_;
}

bool BackwardPass::overAccelerations(const Knot& knot, const ValueModel& next,
                                     const ValueModel& state, const VectorX& w, const VectorX& W,
                                     double rho, Feedback& f, ValueModel& value) {
  withoutForces(knot, next, state);
  Qx_.noalias() += knot.G.transpose() * w;
  Qa_.noalias() += knot.P * w;
  overA_.clear();
  for (int i = 0; i < n_; ++i) {
    double* row = overA_.rowOfA(i);
    std::copy_n(Qaa_.col(i).data(), n_, row);
    std::copy_n(Qxa_.col(i).data(), 2 * n_, row + overA_.first());
    row[overA_.first() + 2 * n_] = Qa_[i];
  }
  overA_.setX(Qxx_, Qx_);
  overA_.addSquares(W, knot.P, knot.G);
  f.slope = Qa_;
  for (int i = 0; i < n_; ++i) f.diagonal[i] = overA_.rowOfA(i)[i];
  // What is left of it where nothing costs: rounding of the largest.
  constexpr double kRounding = 1e-12;
  raised_ = rho * f.diagonal;
  raised_.array() += kRounding * f.diagonal.maxCoeff();
  for (int i = 0; i < n_; ++i) overA_.rowOfA(i)[i] += raised_[i];
  if (!overA_.factor()) return false;
  overA_.gain(f.K, f.k);
  setValue(overA_, rho, f, value);
  return value.slope.allFinite() && value.curvature.allFinite();
}

void BackwardPass::setValue(PartialMinimum& minimum, double rho, Feedback& f, ValueModel& value) {
  const double kQk = f.k.dot(f.slope);
  linear_ += kQk;
  quadratic_ -= 0.5 * (kQk + f.k.dot(raised_.head(f.k.size()).cwiseProduct(f.k)));
  // V is what the function is worth that is not raised.
  minimum.value(rho > 0.0 ? &raised_ : nullptr, value.curvature, value.slope);
  value.mirror();
}

bool BackwardPass::solveAccelerations(const Knot& knot) {
  const int n = n_, ofX = paddedSize(n), ofU = ofX + overU_.columnsOfX();
  dynamics_.setZero();
  for (int i = 0; i < n; ++i) {
    double* row = dynamics_[i];
    std::copy_n(knot.P.col(i).data(), n, row);
    for (int j = 0; j < 2 * n; ++j) row[ofX + j] = -knot.G(i, j);
  }
  for (std::size_t j = 0; j < controlled_.size(); ++j)
    dynamics_[controlled_[j]][ofU + static_cast<int>(j)] = 1.0;
  if (!factorRows(dynamics_, n)) return false;
  solveRows(dynamics_, n, ofX, solved_);
  return true;
}

void BackwardPass::setControls(const Knot& knot, const VectorX& R) {
  const int n = n_, m = static_cast<int>(controlled_.size()), columns = overU_.columnsOfX();
  const Block ax(solved_, paddedSize(n)), S(solved_, paddedSize(n) + columns);
  overU_.clear();
  weighed_.setZero();
  addProduct({Qaa_.data(), n}, ax, n, n, weighed_.stride(), weighed_[0], weighed_.stride());
  // F_aa a_x + F_ax, with F_a behind; ½ F_aa a_x + F_ax, of which a_xᵀ takes twice the symmetric
  // part.
  for (int k = 0; k < n; ++k) {
    double *whole = weighed_[k], *half = half_[k];
    for (int j = 0; j < 2 * n; ++j) {
      half[j] = 0.5 * whole[j] + Qxa_(j, k);
      whole[j] += Qxa_(j, k);
    }
    half[2 * n] = whole[2 * n] = Qa_[k];
  }
  addUpperProduct(1.0, S, {weighed_, columns}, n, m, paddedSize(m), overU_.rowOfA(0),
                  overU_.stride());
  addProduct(S, weighed_, n, m, columns, overU_.rowOfA(0) + overU_.first(), overU_.stride());
  overU_.setX(Qxx_, Qx_);
  addUpperProduct(1.0, ax, half_, n, 2 * n, columns, overU_.rowOfX(0), overU_.stride());
  addUpperProduct(1.0, half_, ax, n, 2 * n, columns, overU_.rowOfX(0), overU_.stride());
  for (int j = 0; j < m; ++j) {
    const int i = controlled_[idx(j)];
    overU_.rowOfA(j)[j] += R[i];
    overU_.rowOfA(j)[overU_.first() + 2 * n] += R[i] * knot.tau[i];
  }
}

bool BackwardPass::setBoundedValue(Feedback& f, ValueModel& value) {
  const int n = n_, m = static_cast<int>(controlled_.size());
  for (int i = 0; i < m; ++i) {
    const double* row = overU_.rowOfA(i);
    for (int j = i; j < m; ++j) Quu_(i, j) = Quu_(j, i) = row[j];
    for (int j = 0; j < 2 * n; ++j) Qux_(i, j) = row[overU_.first() + j];
  }
  raisedControls_ = Quu_;
  raisedControls_.diagonal() += raised_.head(m);
  f.k.setZero();
  if (!box_.solve(raisedControls_, f.slope, lower_, upper_, f.k)) return false;
  box_.gain(Qux_, f.K);
  Qk_.noalias() = Quu_ * f.k;
  linear_ += f.k.dot(f.slope);
  quadratic_ += 0.5 * f.k.dot(Qk_);
  Qk_ += f.slope;
  for (int i = 0; i < 2 * n; ++i) value.slope[i] = overU_.rowOfX(i)[2 * n];
  value.slope.noalias() += f.K.transpose() * Qk_;
  value.slope.noalias() += Qux_.transpose() * f.k;
  // Kᵀ(Q_uu K + Q_ux) + Q_uxᵀK, symmetric.
  QK_.noalias() = 0.5 * Quu_ * f.K;
  QK_ += Qux_;
  KQK_.noalias() = f.K.transpose() * QK_;
  for (int i = 0; i < 2 * n; ++i)
    for (int j = i; j < 2 * n; ++j)
      value.curvature(j, i) = overU_.rowOfX(i)[j] + KQK_(i, j) + KQK_(j, i);
  value.mirror();
  return true;
}

bool BackwardPass::overControls(const Knot& knot, const ValueModel& next, const ValueModel& state,
                                const VectorX& R, const VectorX& lower, const VectorX& upper,
                                double rho, Feedback& f, ValueModel& value) {
  const int m = static_cast<int>(controlled_.size());
  withoutForces(knot, next, state);
  if (!solveAccelerations(knot)) return false;
  setControls(knot, R);
  raised_.setZero();
  for (int j = 0; j < m; ++j) {
    double* row = overU_.rowOfA(j);
    const int i = controlled_[idx(j)];
    f.slope[j] = row[overU_.first() + 2 * n_];
    f.diagonal[j] = row[j];
    lower_[j] = lower[i] - knot.tau[i];
    upper_[j] = upper[i] - knot.tau[i];
    raised_[j] = rho * row[j];
    row[j] += raised_[j];
  }
  if (!overU_.factor()) return false;
  overU_.gain(f.K, f.k);
  if ((f.k.array() >= lower_.array()).all() && (f.k.array() <= upper_.array()).all()) {
    setValue(overU_, rho, f, value);
  } else {
    setControls(knot, R);
    if (!setBoundedValue(f, value)) return false;
  }
  return value.slope.allFinite() && value.curvature.allFinite();
}

}  // namespace softgauss::planning

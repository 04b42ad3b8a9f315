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
      factor_(model.nv),
      box_(static_cast<int>(controlled_.size())) {
  const int n = n_, m = static_cast<int>(controlled_.size());
  for (MatrixX* X : {&VA_, &AVA_, &Qxx_}) *X = MatrixX::Zero(2 * n, 2 * n);
  for (MatrixX* X : {&VB_, &AVB_}) *X = MatrixX::Zero(2 * n, n);
  for (MatrixX* X : {&Qax_, &WG_, &ax_, &FaaAx_}) *X = MatrixX::Zero(n, 2 * n);
  for (MatrixX* X : {&Qaa_, &WP_, &raised_}) *X = MatrixX::Zero(n, n);
  transposed_ = MatrixX::Zero(2 * n, 2 * n);
  for (VectorX* x : {&Qa_, &Bv_, &root_}) *x = VectorX::Zero(n);
  for (VectorX* x : {&Qx_, &Av_}) *x = VectorX::Zero(2 * n);
  Quu_ = raisedControls_ = MatrixX::Zero(m, m);
  Qux_ = MatrixX::Zero(m, 2 * n);
  QK_ = MatrixX::Zero(n, 2 * n);
  S_ = FaaS_ = MatrixX::Zero(n, m);
  lower_ = upper_ = VectorX::Zero(m);
  Qk_ = VectorX::Zero(n);
}

void BackwardPass::withoutForces(const Knot& knot, const ValueModel& next,
                                 const ValueModel& state) {
  const int n = n_;
  const Transition& T = knot.transition;
  T.multiply(next.curvature, VA_, VB_);
  // Aᵀ(V A) = ((V A)ᵀA)ᵀ, and V is symmetric.
  transposed_ = VA_.transpose();
  T.multiply(transposed_, AVA_, AVB_);
  Qxx_.triangularView<Eigen::Lower>() = AVA_;
  Qxx_.triangularView<Eigen::Lower>() += state.curvature;
  Qax_ = AVB_.transpose();
  // Bᵀ(V B), of the upper and lower half of V B.
  raised_ = VB_.topRows(n).transpose();
  Qaa_.noalias() = raised_ * T.byAcceleration().asDiagonal();
  for (const Transition::Rotation& r : T.rotations())
    Qaa_.middleCols<3>(r.dof).noalias() = raised_.middleCols<3>(r.dof) * r.B;
  Qaa_ += T.timestep() * VB_.bottomRows(n).transpose();
  T.transposed(next.slope, Av_, Bv_);
  Qx_ = state.slope + Av_;
  Qa_ = Bv_;
}

void BackwardPass::setValue(const MatrixX& Quu, const MatrixX& Qux, Feedback& f,
                            ValueModel& value) {
  auto Qk = Qk_.head(f.k.size());
  auto QK = QK_.topRows(f.k.size());
  Qk.noalias() = Quu.selfadjointView<Eigen::Lower>() * f.k;
  linear_ += f.k.dot(f.slope);
  quadratic_ += 0.5 * f.k.dot(Qk);
  Qk += f.slope;
  value.slope = Qx_;
  value.slope.noalias() += f.K.transpose() * Qk;
  value.slope.noalias() += Qux.transpose() * f.k;
  // Kᵀ(Q_uu K + Q_ux) + Q_uxᵀK, symmetric.
  QK.noalias() = 0.5 * (Quu.selfadjointView<Eigen::Lower>() * f.K);
  QK += Qux;
  transposed_.noalias() = f.K.transpose() * QK;
  value.curvature.triangularView<Eigen::Lower>() = Qxx_;
  value.curvature.triangularView<Eigen::Lower>() += transposed_;
  value.curvature.triangularView<Eigen::Lower>() += transposed_.transpose();
  value.mirror();
}

bool BackwardPass::overAccelerations(const Knot& knot, const ValueModel& next,
                                     const ValueModel& state, const VectorX& w, const VectorX& W,
                                     double rho, Feedback& f, ValueModel& value) {
  withoutForces(knot, next, state);
  // √W on both sides.
  root_ = W.cwiseSqrt();
  WG_.noalias() = root_.asDiagonal() * knot.G;
  WP_.noalias() = root_.asDiagonal() * knot.P;
  Qxx_.selfadjointView<Eigen::Lower>().rankUpdate(WG_.transpose());
  Qaa_.selfadjointView<Eigen::Lower>().rankUpdate(WP_.transpose());
  Qax_.noalias() += WP_.transpose() * WG_;
  Qx_.noalias() += knot.G.transpose() * w;
  Qa_.noalias() += knot.P * w;
  // What is left of it where nothing costs: rounding of the largest.
  constexpr double kRounding = 1e-12;
  f.slope = Qa_;
  f.diagonal = Qaa_.diagonal();
  root_ = rho * f.diagonal;
  root_.array() += kRounding * f.diagonal.maxCoeff();
  raised_ = Qaa_;
  raised_.diagonal() += root_;
  factor_.compute(raised_);
  if (factor_.info() != Eigen::Success) return false;
  setValueOfFactor(rho > 0.0, f, value);
  return value.slope.allFinite() && value.curvature.allFinite();
}

/// V_t where L Lᵀ = Q_aa + E, E = diag(root_), of which KᵀE K is rounding unless raised by ρ. With
/// Y = L⁻¹Q_ax and y = L⁻¹Q_a, K = −L⁻ᵀY and k = −L⁻ᵀy, what setValue() gives is Q_xx − YᵀY − KᵀE K
/// and Q_x − Yᵀy − KᵀE k.
void BackwardPass::setValueOfFactor(bool raised, Feedback& f, ValueModel& value) {
  const auto L = factor_.matrixL();
  f.k = -Qa_;
  f.K = -Qax_;
  L.solveInPlace(f.k);
  L.solveInPlace(f.K);
  value.slope = Qx_;
  value.slope.noalias() -= f.K.transpose() * f.k;
  Qxx_.selfadjointView<Eigen::Lower>().rankUpdate(f.K.transpose(), -1.0);
  factor_.matrixU().solveInPlace(f.k);
  factor_.matrixU().solveInPlace(f.K);
  Qk_ = root_.cwiseProduct(f.k);
  linear_ += f.k.dot(Qa_);
  quadratic_ -= 0.5 * (f.k.dot(Qa_) + f.k.dot(Qk_));
  value.slope.noalias() -= f.K.transpose() * Qk_;
  if (raised) {
    QK_.noalias() = root_.cwiseSqrt().asDiagonal() * f.K;
    Qxx_.selfadjointView<Eigen::Lower>().rankUpdate(QK_.transpose(), -1.0);
  }
  value.curvature.triangularView<Eigen::Lower>() = Qxx_;
  value.mirror();
}

bool BackwardPass::overControls(const Knot& knot, const ValueModel& next, const ValueModel& state,
                                const VectorX& R, const VectorX& lower, const VectorX& upper,
                                double rho, Feedback& f, ValueModel& value) {
  withoutForces(knot, next, state);
  factor_.compute(knot.P);
  if (factor_.info() != Eigen::Success) return false;
  ax_ = -knot.G;
  factor_.solveInPlace(ax_);
  S_.setZero();
  const int m = static_cast<int>(controlled_.size());
  for (int j = 0; j < m; ++j) S_(controlled_[idx(j)], j) = 1.0;
  factor_.solveInPlace(S_);

  FaaAx_.noalias() = Qaa_ * ax_;
  FaaS_.noalias() = Qaa_ * S_;
  Quu_.noalias() = S_.transpose() * FaaS_;
  FaaAx_ += Qax_;
  Qux_.noalias() = S_.transpose() * FaaAx_;
  // F_axᵀa_x + a_xᵀF_ax + a_xᵀF_aa a_x.
  transposed_.noalias() = ax_.transpose() * FaaAx_;
  transposed_.noalias() += Qax_.transpose() * ax_;
  Qxx_.triangularView<Eigen::Lower>() += transposed_;
  Qx_.noalias() += ax_.transpose() * Qa_;
  f.slope.noalias() = S_.transpose() * Qa_;
  for (int j = 0; j < m; ++j) {
    const int i = controlled_[idx(j)];
    Quu_(j, j) += R[i];
    f.slope[j] += R[i] * knot.tau[i];
    lower_[j] = lower[i] - knot.tau[i];
    upper_[j] = upper[i] - knot.tau[i];
  }
  f.diagonal = Quu_.diagonal();
  raisedControls_ = Quu_;
  raisedControls_.diagonal() += rho * f.diagonal;
  f.k.setZero();
  if (!box_.solve(raisedControls_, f.slope, lower_, upper_, f.k)) return false;
  box_.gain(Qux_, f.K);
  setValue(Quu_, Qux_, f, value);
  return value.slope.allFinite() && value.curvature.allFinite();
}

}  // namespace softgauss::planning

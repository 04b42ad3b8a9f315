// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/cost.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/core/vector_clones.hpp"
#include "softgauss/engine/core/vector_kernels.hpp"
#include "softgauss/gdd/weighted_rows.hpp"

namespace softgauss::gdd {
namespace {

/// K ← K + scale · YᵀY of these rows of Y, lower triangle by columns (and what lies in its blocks
/// of four): column i of K gains scale · Σ_k Y_ki Y_k,i…
SOFTGAUSS_VECTOR_CLONES void addGram(const RowMajorMatrixX& Y, Segment rows, double scale,
                                     MatrixX& K) {
  const int count = rows.end - rows.begin, n = static_cast<int>(Y.cols());
  const double* first = Y.data() + rows.begin * n;
  for (int i = 0; i < n; ++i) {
    const int from = i & ~3;
    addCombination(scale, first + i, n, first + from, n, count, n - from, K.data() + i * n + from);
  }
}

/// K ← K + scale · yyᵀ, the same part of it.
SOFTGAUSS_VECTOR_CLONES void addRankOne(const double* y, double scale, MatrixX& K) {
  const int n = static_cast<int>(K.rows());
  for (int i = 0; i < n; ++i) {
    const int from = i & ~3;
    addScaled(scale * y[i], y + from, n - from, K.data() + i * n + from);
  }
}

/// J a of row i, of these dofs.
double rowTimes(Segments dofs, const MatrixX& rows, std::size_t i, const VectorX& a) {
  const auto J = rows.col(static_cast<Eigen::Index>(i));
  double sum = 0.0;
  for (const Segment s : dofs) sum += J.segment(s.begin, s.end - s.begin).dot(part(a, s));
  return sum;
}

/// g ← g + scale Jᵀ of row i, of these dofs.
void addRow(Segments dofs, double scale, const MatrixX& rows, std::size_t i, VectorX& g) {
  const auto J = rows.col(static_cast<Eigen::Index>(i));
  for (const Segment s : dofs) part(g, s) += scale * J.segment(s.begin, s.end - s.begin);
}

}  // namespace

void GoalCost::clear(const ForceMetric& R, Segments dofs) {
  addedDofs_.assign(dofs.begin(), dofs.end());
  select(-1);
  rows_.clear();
  share_ = 1.0;
  weight_.clear();
  target_.clear();
  denseWeight_.clear();
  denseTarget_.clear();
  sides_.clear();
  for (VectorX* x : {&dofWeight_, &dofOffset_, &metricSlope_}) setZero(dofs, *x);
  controlCost_.set(R);
  functions_.clear();
  forces_.clear();
  metricWeight_ = 0.0;
}

void GoalCost::reserve(int controls, int contacts) {
  const Eigen::Index dofs = dofWeight_.size();
  const Eigen::Index most = static_cast<Eigen::Index>(denseWeight_.size()) + 2 * dofs;
  if (dense_.cols() < most) dense_.conservativeResize(dofs, most);
  for (std::vector<double>* list : {&denseWeight_, &denseTarget_})
    list->reserve(static_cast<std::size_t>(most));
  sides_.reserve(static_cast<std::size_t>(most));
  points_.reserve(static_cast<std::size_t>(dofs), weight_.capacity());  // an island has a dof
  denseRows_.reserve(static_cast<std::size_t>(dofs), static_cast<std::size_t>(most));
  reduced_.resize(paddedSize(controls));
  forces_.reserve(contacts);
}

void GoalCost::addPoint(const Model& model, const Kinematics& k, const TreeSparsity& tree, int body,
                        const Vector3& p_WP, double weight, const Vector3& target) {
  RelativeMotion motion;  // against the world
  motion.bodyB = body;
  motion.p_WA = motion.p_WB = p_WP;
  motion.linearDim = 3;
  rows_.add(model, k, tree, motion);
  weight_.push_back(share_ * weight);
  target_.push_back(target);
}

void GoalCost::addRows(const Eigen::Ref<const MatrixX>& J, double weight,
                       const Eigen::Ref<const VectorX>& target) {
  SOFTGAUSS_ASSERT(J.cols() == dofWeight_.size() && J.rows() == target.size());
  const Eigen::Index used = static_cast<Eigen::Index>(denseWeight_.size());
  if (dense_.cols() < used + J.rows())
    dense_.conservativeResize(J.cols(), 2 * used + J.rows());  // room that later steps keep
  dense_.middleCols(used, J.rows()) = J.transpose();
  for (Eigen::Index i = 0; i < J.rows(); ++i) {
    denseWeight_.push_back(share_ * weight);
    denseTarget_.push_back(target[i]);
  }
}

GoalCost::OneSided& GoalCost::addSide(double weight, double least) {
  const std::size_t used = denseWeight_.size();
  const auto room = static_cast<Eigen::Index>(used);
  if (dense_.cols() <= room) dense_.conservativeResize(dofWeight_.size(), 2 * room + 1);
  denseWeight_.push_back(0.0);
  denseTarget_.push_back(least);
  sides_.push_back({used, share_ * weight});
  return sides_.back();
}

void GoalCost::addOneSided(const VectorX& J, double weight, double least) {
  SOFTGAUSS_ASSERT(J.size() == dofWeight_.size());
  dense_.col(static_cast<Eigen::Index>(addSide(weight, least).row)) = J;
}

void GoalCost::addOneSided(int dof, double sign, double weight, double least) {
  OneSided& side = addSide(weight, least);
  side.dof = dof;
  side.sign = sign;
  auto J = dense_.col(static_cast<Eigen::Index>(side.row));
  J.setZero();
  J[dof] = sign;
}

bool GoalCost::chooseSides(const VectorX& a, bool first) {
  constexpr double kRounding = 1e-10;  // either side will do
  bool changed = false;
  for (const OneSided& side : sides_) {
    if (island_ >= 0 && !denseRows_.has(island_, static_cast<int>(side.row))) continue;
    const double least = denseTarget_[side.row];
    const double is =
        side.dof >= 0 ? side.sign * a[side.dof] : rowTimes(dofs(), dense_, side.row, a);
    const double rounding = kRounding * (1.0 + std::abs(least) + std::abs(is));
    double& weight = denseWeight_[side.row];
    const bool counts = weight > 0.0;
    if (side.weight == 0.0 || (counts ? least - is >= -rounding : least - is <= rounding)) continue;
    weight = counts ? 0.0 : side.weight;
    changed = true;
    if (first) break;
  }
  return changed;
}

void GoalCost::addDof(int dof, double weight, double target) {
  dofWeight_[dof] += share_ * weight;
  dofOffset_[dof] -= share_ * weight * target;
}

double GoalCost::value(const VectorX& a, const VectorX& Ma) const {
  double sum = 0.0;
  forEachPoint([&](std::size_t i) {
    Vector3 y;
    rows_.multiply(static_cast<int>(i), a, y.data());
    sum += 0.5 * weight_[i] * (y - target_[i]).squaredNorm();
  });
  forEachRow([&](std::size_t i) {
    if (denseWeight_[i] == 0.0) return;
    const double error = rowTimes(dofs(), dense_, i, a) - denseTarget_[i];
    sum += 0.5 * denseWeight_[i] * error * error;
  });
  if (hasFunctions()) sum += expansionValue(a);
  sum += 0.5 * dot(dofs(), a, dofWeight_, a) + dot(dofs(), a, dofOffset_);
  return sum + 0.5 * metricWeight_ * dot(dofs(), a, Ma) + dot(dofs(), a, metricSlope_);
}

void GoalCost::gradient(const VectorX& a, const VectorX& Ma, VectorX& g) const {
  g.setZero(a.size());
  for (const Segment s : dofs()) part(g, s) = metricWeight_ * part(Ma, s) + part(metricSlope_, s);
  forEachPoint([&](std::size_t i) {
    Vector3 y;
    rows_.multiply(static_cast<int>(i), a, y.data());
    const Vector3 slope = weight_[i] * (y - target_[i]);
    rows_.addTransposed(static_cast<int>(i), slope.data(), g);
  });
  forEachRow([&](std::size_t i) {
    if (denseWeight_[i] == 0.0) return;
    const double slope = denseWeight_[i] * (rowTimes(dofs(), dense_, i, a) - denseTarget_[i]);
    addRow(dofs(), slope, dense_, i, g);
  });
  for (const Segment s : dofs())
    part(g, s) += part(dofWeight_, s).cwiseProduct(part(a, s)) + part(dofOffset_, s);
  if (hasFunctions()) g += expansionSlope_ + expansionCurvature_ * (a - expandedAt_);
}

void GoalCost::multiplyCurvature(const VectorX& d, const VectorX& Md, VectorX& Hd) const {
  Hd.setZero(d.size());
  for (const Segment s : dofs())
    part(Hd, s) = metricWeight_ * part(Md, s) + part(dofWeight_, s).cwiseProduct(part(d, s));
  forEachPoint([&](std::size_t i) {
    Vector3 y;
    rows_.multiply(static_cast<int>(i), d, y.data());
    y *= weight_[i];
    rows_.addTransposed(static_cast<int>(i), y.data(), Hd);
  });
  forEachRow([&](std::size_t i) {
    if (denseWeight_[i] == 0.0) return;
    addRow(dofs(), denseWeight_[i] * rowTimes(dofs(), dense_, i, d), dense_, i, Hd);
  });
  if (hasFunctions()) Hd += expansionCurvature_ * d;
}

double GoalCost::curvatureAlong(const VectorX& d, const VectorX& Md) const {
  double sum = metricWeight_ * dot(dofs(), d, Md) + dot(dofs(), d, dofWeight_, d);
  if (hasFunctions()) sum += d.dot(expansionCurvature_ * d);
  forEachPoint([&](std::size_t i) {
    Vector3 y;
    rows_.multiply(static_cast<int>(i), d, y.data());
    sum += weight_[i] * y.squaredNorm();
  });
  forEachRow([&](std::size_t i) {
    if (denseWeight_[i] == 0.0) return;
    const double rate = rowTimes(dofs(), dense_, i, d);
    sum += denseWeight_[i] * rate * rate;
  });
  return sum;
}

void GoalCost::addQuadraticCurvature(TreeMatrix& H) {
  for (int i = 0; i < rows_.size(); ++i) {
    const double w = weight_[i];
    const double diagonal[9] = {w, 0, 0, 0, w, 0, 0, 0, w};
    rows_.addCurvature(i, diagonal, H);
  }
  const int n = static_cast<int>(dofWeight_.size());
  for (std::size_t r = 0; r < denseWeight_.size(); ++r) {
    if (denseWeight_[r] == 0.0) continue;
    const auto J = dense_.col(static_cast<Eigen::Index>(r));
    for (int i = 0; i < n; ++i) {
      const double scale = denseWeight_[r] * J[i];
      if (scale == 0.0) continue;
      double* row = H.row(i);
      for (int j = 0; j <= i; ++j) row[j] += scale * J[j];
    }
  }
  for (int i = 0; i < n; ++i) H.row(i)[i] += dofWeight_[i];
}

void GoalCost::addRowCurvature(TreeMatrix& H) {
  addQuadraticCurvature(H);
  if (!hasFunctions()) return;
  const int n = H.size();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) H.row(i)[j] += expansionCurvature_(i, j);
}

double GoalCost::functions(const VectorX& a, VectorX& gradient, MatrixX& hessian) {
  const Eigen::Index n = a.size();
  VectorX g = VectorX::Zero(n);
  MatrixX H = MatrixX::Zero(n, n);
  gradient.setZero(n);
  hessian.setZero(n, n);
  double sum = 0.0;
  for (const Function& function : functions_) {
    sum += function(a, g, H);
    gradient += g;
    hessian += H;
  }
  return sum;
}

bool GoalCost::expand(const TreeMatrix& M, const VectorX& a, double mu) {
  expandedAt_ = a;
  expansionStart_ = functions(a, expansionSlope_, expansionCurvature_);
  if (!std::isfinite(expansionStart_) || !expansionSlope_.allFinite() ||
      !expansionCurvature_.allFinite())
    return false;
  raiseCurvature(M, expansionCurvature_);
  if (mu > 0.0) expansionCurvature_ += mu * M.dense();
  return true;
}

void GoalCost::raiseCurvature(const TreeMatrix& M, MatrixX& H) const {
  constexpr double kShare = 0.9;
  const MatrixX mass = M.dense();
  double least = -kShare;
  if (!controlCost_.hasInverseMass()) {
    // R − σ M⁻¹ ⪰ 0 is LᵀR L ⪰ σ with M = L Lᵀ.
    const MatrixX L = Eigen::LLT<MatrixX>(mass).matrixL();
    const MatrixX seen = L.transpose() * controlCost_.dense() * L;
    least *= std::min(1.0, Eigen::SelfAdjointEigenSolver<MatrixX>(seen).eigenvalues().minCoeff());
  }
  if (Eigen::LLT<MatrixX>(H - least * mass).info() == Eigen::Success) return;
  // H = M X Λ XᵀM with XᵀM X = 1.
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixX> eigen(H, mass);
  const MatrixX MX = mass * eigen.eigenvectors();
  H = MX * eigen.eigenvalues().cwiseMax(least).asDiagonal() * MX.transpose();
}

double GoalCost::expansionValue(const VectorX& a) const {
  const VectorX d = a - expandedAt_;
  return expansionStart_ + expansionSlope_.dot(d) + 0.5 * d.dot(expansionCurvature_ * d);
}

VectorX GoalCost::expansionGradient(const VectorX& a) const {
  return expansionSlope_ + expansionCurvature_ * (a - expandedAt_);
}

double GoalCost::functionValue(const VectorX& a) {
  VectorX gradient;
  MatrixX hessian;
  return functions(a, gradient, hessian);
}

double GoalCost::expansionError(const VectorX& a, const VectorX& scale) {
  VectorX gradient;
  MatrixX hessian;
  functions(a, gradient, hessian);
  const VectorX error = gradient - expansionGradient(a);
  const double size = gradient.cwiseProduct(scale).cwiseAbs().maxCoeff();
  return error.cwiseProduct(scale).cwiseAbs().maxCoeff() / std::max(1.0, size);
}

void GoalCost::addReducedCurvature(const TreeFactor& massFactor, const RowMajorMatrixX& S,
                                   RowMajorMatrixX& rootS, MatrixX& K) const {
  if (metricWeight_ != 0.0) {
    massFactor.multiplyRoot(S, rootS);
    for (const Segment s : dofs()) addGram(rootS, s, metricWeight_, K);
  }
  // One rank for each row of J, and for each dof.
  if (reduced_.size() < S.cols()) reduced_.resize(S.cols());
  const auto addRank = [&](const double* row, double weight) {
    reduced_.head(S.cols()).setZero();
    for (const Segment s : dofs())
      addWeightedRows(row + s.begin, &S(s.begin, 0), s.end - s.begin, static_cast<int>(S.cols()),
                      reduced_.data());
    addRankOne(reduced_.data(), weight, K);
  };
  forEachPoint([&](std::size_t i) {
    for (int k = 0; k < 3; ++k) {
      const double unit[3] = {k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0};
      scratch_.setZero();
      rows_.addTransposed(static_cast<int>(i), unit, scratch_);
      addRank(scratch_.data(), weight_[i]);
    }
  });
  forEachRow([&](std::size_t i) {
    if (denseWeight_[i] != 0.0)
      addRank(dense_.col(static_cast<Eigen::Index>(i)).data(), denseWeight_[i]);
  });
  for (const Segment s : dofs())
    for (Eigen::Index i = s.begin; i < s.end; ++i)
      if (dofWeight_[i] != 0.0) addRankOne(&S(i, 0), dofWeight_[i], K);
  if (hasFunctions()) K.triangularView<Eigen::Lower>() += S.transpose() * (expansionCurvature_ * S);
}

}  // namespace softgauss::gdd

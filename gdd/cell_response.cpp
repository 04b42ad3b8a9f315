// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/cell_response.hpp"

#include <algorithm>

#include "softgauss/engine/core/vector_clones.hpp"
#include "softgauss/engine/core/vector_kernels.hpp"
#include "softgauss/gdd/weighted_rows.hpp"

namespace softgauss::gdd {
namespace {

/// K ← K − s bᵀ − b sᵀ, lower triangle by columns.
SOFTGAUSS_VECTOR_CLONES void subtractRankTwo(const double* s, const double* b, int n, double* K) {
  for (int i = 0; i < n; ++i) {
    const int from = i & ~3;
    addScaled(-s[i], b + from, n - from, K + i * n + from);
    addScaled(-b[i], s + from, n - from, K + i * n + from);
  }
}

/// S ← S − scale · y sᵀ, of these rows.
SOFTGAUSS_VECTOR_CLONES void subtractRankOne(Segments rows, const double* y, const double* s,
                                             double scale, RowMajorMatrixX& S) {
  const int columns = static_cast<int>(S.cols());
  for (const Segment part : rows)
    for (int i = part.begin; i < part.end; ++i)
      addScaled(-scale * y[i], s, columns, S.data() + i * columns);
}

/// K ← K + Σ_k c_k y_k y_kᵀ (n × n) over the dofs of a factor, y_k row k of Y, which is zero but in
/// range k.
SOFTGAUSS_VECTOR_CLONES void addWeightedGram(const RowMajorMatrixX& Y, const TreeFactor& factor,
                                             const std::vector<Segment>& range, MatrixX& K) {
  const int n = static_cast<int>(Y.cols());
  for (const Segment part : factor.dofs())
    for (int k = part.begin, end; k < part.end; k = end) {
      const Segment r = range[k];
      end = endOfRun(range, k, part.end);
      const double *y = Y.data() + k * n, *inverse = factor.inversePivots() + k;
      double* to = K.data();
      for (int i = r.begin; i < r.end; ++i)
        addSum(
            end - k, [=](int j) { return inverse[j] * y[j * n + i]; },
            [=](int j) { return y + j * n + r.begin; }, r.end - r.begin, to + i * n + r.begin);
    }
}

}  // namespace

void CellResponse::setDriven(const Model& model, const ControlLimits& limits, Segments dofs) {
  dofs_ = dofs;
  driven_.clear();
  fixed_.setZero(model.nv);
  for (const Segment s : dofs_)
    for (int i = s.begin; i < s.end; ++i)
      if (limits.lower[i] < limits.upper[i])
        driven_.push_back(i);
      else
        fixed_[i] = limits.lower[i];
  transmission_ = limits.transmission;
  givenForce_ = fixed_;
  if (!transmission_) return;
  B_.resize(model.nv, columns());
  for (int c = 0; c < columns(); ++c) B_.col(c) = transmission_->T().col(driven_[c]);
  givenForce_.noalias() = transmission_->T() * fixed_;
}

/// X ← B, and the range of each row.
void CellResponse::setColumns(RowMajorMatrixX& X) {
  const int n = M_->size();
  X.resize(n, padded());
  range_.resize(static_cast<std::size_t>(n));
  for (const Segment s : dofs_) {
    X.middleRows(s.begin, s.end - s.begin).setZero();
    std::fill(range_.begin() + s.begin, range_.begin() + s.end, Segment{});
  }
  const auto set = [&](int dof, int c, double x) {
    X(dof, c) = x;
    Segment& range = range_[dof];
    if (range.begin == range.end) range.begin = c;
    range.end = c + 1;
  };
  for (int c = 0; c < columns(); ++c) {
    if (!transmission_) {
      set(driven_[c], c, 1.0);
      continue;
    }
    for (const Segment s : dofs_)
      for (int i = s.begin; i < s.end; ++i)
        if (B_(i, c) != 0.0) set(i, c, B_(i, c));
  }
}

bool CellResponse::setInertia(const Data& data, const GoalCost& cost) {
  M_ = &data.inertia.M;
  cost_ = &cost;
  controlCost_ = cost.controlCost();
  if (!massFactor_.compute(data.inertia.hat(), dofs_)) return false;
  // Goals weigh by M itself.
  goalMassFactor_ = data.inertia.anyAdded ? &ownGoalMassFactor_ : &massFactor_;
  if (data.inertia.anyAdded && cost.metricWeight() != 0.0 &&
      !ownGoalMassFactor_.compute(data.inertia.M, dofs_))
    return false;
  controlCost_.prepare(massFactor_);
  computeControlCost();
  return true;
}

/// BᵀR B, its part of M⁻¹ as BᵀM⁻¹B = YᵀD⁻¹Y, Y = L⁻ᵀB, M = LᵀDL. Row k of Y has entries only where
/// a column of B moves dof k or one that it carries.
void CellResponse::computeControlCost() {
  const int count = padded();
  RowMajorMatrixX& Y = rootS_;
  reducedControlCost_.setZero(count, count);
  if (controlCost_.hasInverseMass()) {
    setColumns(Y);
    massFactor_.solveTransposed(Y, range_);
    addWeightedGram(Y, massFactor_, range_, reducedControlCost_);
  }
  const int n = columns();
  if (transmission_) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        reducedControlCost_(i, j) += B_.col(i).cwiseProduct(controlCost_.diagonal()).dot(B_.col(j));
  } else {
    for (int i = 0; i < n; ++i) reducedControlCost_(i, i) += controlCost_.diagonal()[driven_[i]];
  }
  for (int k = 0; k < controlCost_.directionCount(); ++k) {
    scratch_ = controlCost_.direction(k);
    select(scratch_, pull_);
    reducedControlCost_.topLeftCorner(n, n).noalias() += pull_ * pull_.transpose();
  }
}

void CellResponse::multiplyTransposed(const VectorX& x, VectorX& y) const {
  padded_.setZero(padded());
  addWeighted(S_, x, padded_);
  y = padded_.head(columns());
}

void CellResponse::addWeighted(const RowMajorMatrixX& X, const VectorX& x, VectorX& y) const {
  for (const Segment s : dofs_)
    addWeightedRows(x.data() + s.begin, X.data() + s.begin * padded(), s.end - s.begin, padded(),
                    y.data());
}

void CellResponse::multiplyControlCost(const VectorX& p, VectorX& y) const {
  padded_.setZero(padded());
  addWeightedRows(p.data(), reducedControlCost_.data(), columns(), padded(), padded_.data());
  y = padded_.head(columns());
}

bool CellResponse::enter(Data& data) {
  if (data.constraints.active().empty()) {
    enterWith(massFactor_);
    return true;
  }
  P_.resize(data.constraints.sparsity());
  P_.assign(data.inertia.hat(), dofs_);
  data.constraints.addCurvature(P_);
  enterWith(cellFactor_);
  return cellFactor_.compute(P_, dofs_);
}

void CellResponse::reserve(int crossings) {
  corrections_.resize(std::max(corrections_.size(), static_cast<std::size_t>(crossings)));
  for (VectorX* x : {&My_, &scratch_}) x->setZero(M_->size());
  b_.setZero(padded());
  for (Correction& c : corrections_) {
    for (VectorX* x : {&c.y, &c.Hy}) x->setZero(M_->size());
    c.By.setZero(padded());
  }
  correctionCount_ = 0;
}

void CellResponse::enterWith(const TreeFactor& factor) {
  factor_ = &factor;
  correctionCount_ = 0;
  correctionsInS_ = -1;
}

void CellResponse::solve(VectorX& x) const {
  if (correctionCount_ == 0) return factor_->solve(x);
  scratch_ = x;
  factor_->solve(x);
  for (int k = 0; k < correctionCount_; ++k) {
    const Correction& c = corrections_[k];
    x -= c.scale * dot(dofs_, c.y, scratch_) * c.y;
  }
}

void CellResponse::multiplyR(const VectorX& x, VectorX& Rx) const {
  controlCost_.multiply(massFactor_, x, Rx);
}

const CellResponse::Correction& CellResponse::cross(const VectorX& J, double jump) {
  if (correctionCount_ == static_cast<int>(corrections_.size())) corrections_.emplace_back();
  Correction& c = corrections_[correctionCount_];
  c.y = J;
  solve(c.y);
  ++correctionCount_;
  c.By.setZero(padded());
  if (transmission_)
    c.By.head(columns()).noalias() = B_.transpose() * c.y;
  else
    for (int i = 0; i < columns(); ++i) c.By[i] = c.y[driven_[i]];
  c.scale = jump / (1.0 + jump * dot(dofs_, J, c.y));
  if (correctionsInS_ >= 0) {
    My_.setZero(c.y.size());
    M_->multiply(dofs_, c.y, My_);
    cost_->multiplyCurvature(c.y, My_, c.Hy);
  }
  return c;
}

void CellResponse::addToHessian(ContactForceTerms& forces) {
  forceK_ = K_;
  forces.addReducedCurvature(S_, forceK_);
  withForces_ = true;
}

void CellResponse::computeHessian() {
  withForces_ = false;
  if (correctionsInS_ < 0) {
    setColumns(S_);
    factor_->solve(S_, range_);
    for (int k = 0; k < correctionCount_; ++k)
      subtractRankOne(dofs_, corrections_[k].y.data(), corrections_[k].By.data(),
                      corrections_[k].scale, S_);
    K_ = reducedControlCost_;
    rootS_.resize(S_.rows(), S_.cols());
    cost_->addReducedCurvature(*goalMassFactor_, S_, rootS_, K_);
    correctionsInS_ = correctionCount_;
  }
  for (; correctionsInS_ < correctionCount_; ++correctionsInS_)
    addToHessian(corrections_[correctionsInS_]);
}

/// K and S of the cell behind one more crossing.
void CellResponse::addToHessian(const Correction& c) {
  b_.setZero(padded());
  addWeighted(S_, c.Hy, b_);
  b_ = c.scale * b_ - 0.5 * c.scale * c.scale * dot(dofs_, c.y, c.Hy) * c.By;
  subtractRankTwo(c.By.data(), b_.data(), padded(), K_.data());
  subtractRankOne(dofs_, c.y.data(), c.By.data(), c.scale, S_);
}

void CellResponse::select(const VectorX& x, VectorX& y) const {
  if (!transmission_) return pick(x, y);
  y.noalias() = B_.transpose() * x;
}

void CellResponse::spread(const VectorX& u, VectorX& tau) const {
  if (transmission_) {
    tau.noalias() = B_ * u;
    return;
  }
  for (int i = 0; i < columns(); ++i) tau[driven_[i]] = u[i];
}

void CellResponse::force(const VectorX& u, VectorX& tau) const {
  if (!transmission_) return place(u, tau);
  tau = givenForce_;
  tau.noalias() += B_ * u;
}

void CellResponse::pick(const VectorX& y, VectorX& u) const {
  u.resize(columns());
  for (int i = 0; i < columns(); ++i) u[i] = y[driven_[i]];
}

void CellResponse::place(const VectorX& u, VectorX& y) const {
  y.resize(fixed_.size());
  copy(dofs_, fixed_, y);
  for (int i = 0; i < columns(); ++i) y[driven_[i]] = u[i];
}

void CellResponse::controls(const VectorX& tau, VectorX& u) const {
  if (!transmission_) return pick(tau, u);
  u.resize(columns());
  for (int i = 0; i < columns(); ++i) u[i] = transmission_->C().row(driven_[i]).dot(tau);
}

}  // namespace softgauss::gdd

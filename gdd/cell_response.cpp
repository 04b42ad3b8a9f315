// SPDX-License-Identifier: Apache-2.0
#include "gdd/cell_response.hpp"

namespace softgauss::gdd {
namespace {

/// X ← B.
void setSelection(const std::vector<int>& driven, int dofs, RowMajorMatrixX& X) {
  X.setZero(dofs, static_cast<Eigen::Index>(driven.size()));
  for (std::size_t c = 0; c < driven.size(); ++c) X(driven[c], static_cast<Eigen::Index>(c)) = 1.0;
}

}  // namespace

void CellResponse::setDriven(const Model& model, const ControlBox& box) {
  driven_.clear();
  for (int i = 0; i < model.nv; ++i)
    if (box.lower[i] < box.upper[i]) driven_.push_back(i);
}

bool CellResponse::setInertia(const Data& data, const GoalCost& cost) {
  price_ = cost.forcePrice();
  massFactor_ = data.forward.massFactored ? &data.forward.massFactor : &ownMassFactor_;
  if (!data.forward.massFactored && !ownMassFactor_.compute(data.inertia.M)) return false;
  const int n = data.inertia.M.size();
  setSelection(driven_, n, S_);
  massFactor_->solve(S_);
  forcePrice_.resize(columns(), columns());
  for (int i = 0; i < columns(); ++i) {
    forcePrice_.row(i) = S_.row(driven_[i]);
    forcePrice_(i, i) += price_[driven_[i]];
  }
  rootS_.resize(n, columns());
  return true;
}

bool CellResponse::enter(Data& data) {
  P_.resize(data.constraints.sparsity());
  P_.assign(data.inertia.M);
  data.constraints.addCurvature(P_);
  enterWith(ownFactor_);
  return ownFactor_.compute(P_);
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
    x -= c.scale * c.y.dot(scratch_) * c.y;
  }
}

void CellResponse::multiplyR(const VectorX& x, VectorX& Rx) const {
  Rx = x;
  massFactor_->solve(Rx);
  Rx += price_.cwiseProduct(x);
}

double CellResponse::cross(const VectorX& J, double jump, VectorX& PinvJ) {
  PinvJ = J;
  solve(PinvJ);
  if (correctionCount_ == static_cast<int>(corrections_.size())) corrections_.emplace_back();
  Correction& c = corrections_[correctionCount_++];
  c.y = PinvJ;
  select(c.y, c.By);
  c.scale = jump / (1.0 + jump * J.dot(PinvJ));
  return c.scale;
}

void CellResponse::computeHessian(const GoalCost& cost) {
  if (correctionsInS_ < 0) {
    setSelection(driven_, factor_->size(), S_);
    factor_->solve(S_);
    correctionsInS_ = 0;
  }
  for (; correctionsInS_ < correctionCount_; ++correctionsInS_) {
    const Correction& c = corrections_[correctionsInS_];
    for (Eigen::Index i = 0; i < S_.rows(); ++i) S_.row(i) -= c.scale * c.y[i] * c.By.transpose();
  }
  K_ = forcePrice_;
  cost.addReducedCurvature(*massFactor_, S_, rootS_, K_);
}

void CellResponse::select(const VectorX& x, VectorX& y) const {
  y.resize(columns());
  for (int i = 0; i < columns(); ++i) y[i] = x[driven_[i]];
}

void CellResponse::spread(const VectorX& u, VectorX& tau) const {
  for (int i = 0; i < columns(); ++i) tau[driven_[i]] = u[i];
}

double CellResponse::forceCurvature(const VectorX& p) const {
  pricedStep_.noalias() = forcePrice_ * p;
  return p.dot(pricedStep_);
}

}  // namespace softgauss::gdd

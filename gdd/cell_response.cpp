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

bool CellResponse::setInertia(const Data& data) {
  massFactor_ = data.forward.massFactored ? &data.forward.massFactor : &ownMassFactor_;
  if (!data.forward.massFactored && !ownMassFactor_.compute(data.inertia.M)) return false;
  const int n = data.inertia.M.size();
  setSelection(driven_, n, S_);
  massFactor_->solve(S_);
  forcePrice_.resize(columns(), columns());
  for (int i = 0; i < columns(); ++i) forcePrice_.row(i) = S_.row(driven_[i]);
  MS_.resize(n, columns());
  return true;
}

bool CellResponse::enter(Data& data) {
  P_.resize(data.constraints.sparsity());
  P_.assign(data.inertia.M);
  data.constraints.addCurvature(P_);
  factor_ = &ownFactor_;
  return ownFactor_.compute(P_);
}

void CellResponse::computeHessian(const GoalCost& cost, const Data& data) {
  setSelection(driven_, data.inertia.M.size(), S_);
  factor_->solve(S_);
  K_ = forcePrice_;
  cost.addReducedCurvature(data.inertia.M, S_, MS_, K_);
}

void CellResponse::select(const VectorX& x, VectorX& y) const {
  y.resize(columns());
  for (int i = 0; i < columns(); ++i) y[i] = x[driven_[i]];
}

void CellResponse::spread(const VectorX& u, VectorX& tau) const {
  for (int i = 0; i < columns(); ++i) tau[driven_[i]] = u[i];
}

double CellResponse::forceCurvature(const VectorX& p) const {
  return p.dot(forcePrice_.selfadjointView<Eigen::Lower>() * p);
}

}  // namespace softgauss::gdd

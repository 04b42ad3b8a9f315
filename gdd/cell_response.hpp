// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How acceleration answers control in one cell, and what that makes of the objective (T.60):
///
///   S = P⁻¹B,   K = BᵀR B + Sᵀ∇²ℓ S,   P = M + Jᵀ∇²s J,   R = M⁻¹ + W
///
/// W is the price of single forces. B has a unit column for each dof that is driven. All columns
/// are solved for at once. Where a row changes its piece, P changes by Δs″ JᵀJ, and nothing is
/// factored anew (T.62):
///   P⁻¹ ← P⁻¹ − γ y yᵀ,   y = P⁻¹Jᵀ,   γ = Δs″/(1 + Δs″ J y),   S ← S − γ y (Bᵀy)ᵀ

#include <vector>

#include "engine/step/data.hpp"
#include "gdd/cost.hpp"
#include "gdd/problem.hpp"

namespace softgauss::gdd {

class CellResponse {
 public:
  CellResponse() = default;
  CellResponse(const CellResponse&) = delete;  // factors are pointed at
  CellResponse& operator=(const CellResponse&) = delete;

  /// Takes B from the box.
  void setDriven(const Model& model, const ControlBox& box);
  /// Takes R from M and W from the cost, after a forward solve. Returns false when M is not
  /// positive definite.
  bool setInertia(const Data& data, const GoalCost& cost);

  /// P of the cell in which the rows are kept. Returns false when it cannot be factored.
  bool enter(Data& data);
  /// P of the forward solve that has just ended in this cell.
  void enterWith(const TreeFactor& factor);
  /// The next cell, in which the row J (nv) has `jump` more curvature. Returns γ, and P⁻¹Jᵀ of the
  /// cell that is left.
  double cross(const VectorX& J, double jump, VectorX& PinvJ);
  /// Whether so many rows have been crossed that it is better to enter() anew.
  bool isWorn() const { return correctionCount_ > kMaxCorrections; }
  /// K of this cell.
  void computeHessian(const GoalCost& cost);

  int columns() const { return static_cast<int>(driven_.size()); }
  const std::vector<int>& driven() const { return driven_; }  ///< the dof of each column of B
  void select(const VectorX& x, VectorX& y) const;            ///< y ← Bᵀx
  void spread(const VectorX& u, VectorX& tau) const;          ///< tau ← B u on driven dofs
  void solve(VectorX& x) const;                               ///< x ← P⁻¹x
  void multiplyR(const VectorX& x, VectorX& Rx) const;        ///< Rx ← (R + W) x
  const MatrixX& hessian() const { return K_; }               ///< lower triangle
  /// pᵀBᵀR B p.
  double forceCurvature(const VectorX& p) const;
  int massFailedRow() const { return massFactor_->failedRow(); }

 private:
  struct Correction {
    VectorX y, By;  ///< P⁻¹Jᵀ, Bᵀ of it
    double scale = 0.0;
  };
  static constexpr int kMaxCorrections = 16;

  std::vector<int> driven_;
  TreeFactor ownMassFactor_, ownFactor_;
  const TreeFactor* massFactor_ = &ownMassFactor_;
  const TreeFactor* factor_ = &ownFactor_;  ///< of P before the corrections
  std::vector<Correction> corrections_;     ///< the first correctionCount_ are in use
  int correctionCount_ = 0;
  int correctionsInS_ = 0;  ///< −1: S is not of this factor
  TreeMatrix P_;
  RowMajorMatrixX S_, rootS_;
  VectorX price_;       ///< W (nv)
  MatrixX forcePrice_;  ///< BᵀR B
  MatrixX K_;
  mutable VectorX scratch_, pricedStep_;
};

}  // namespace softgauss::gdd

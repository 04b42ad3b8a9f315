// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How acceleration answers control in one cell, and what that makes of the objective (10.7):
///
///   S = P⁻¹B,   K = BᵀR B + Sᵀ∇²ℓ S,   P = M + Jᵀ∇²s J
///
/// of some dofs, which nothing couples with others: vectors of all nv have zeros elsewhere.
/// R holds the prices W. B has a column for each coordinate of force whose box is open
/// (problem.hpp): a unit column where that is the force on a dof. All columns are solved for at
/// once. Where a row changes its piece, P changes by Δs″ JᵀJ, and nothing is factored anew (10.9):
///   P⁻¹ ← P⁻¹ − γ y yᵀ,   y = P⁻¹Jᵀ,   γ = Δs″/(1 + Δs″ J y),   S ← S − γ y sᵀ,   s = Bᵀy
///   K ← K − s bᵀ − b sᵀ,   b = γ Sᵀ∇²ℓ y − ½ γ² (yᵀ∇²ℓ y) s

#include <vector>

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/core/vector_kernels.hpp"
#include "softgauss/engine/step/data.hpp"
#include "softgauss/gdd/cost.hpp"
#include "softgauss/gdd/problem.hpp"

namespace softgauss::gdd {

class CellResponse {
 public:
  CellResponse() = default;
  CellResponse(const CellResponse&) = delete;  // factors are pointed at
  CellResponse& operator=(const CellResponse&) = delete;

  /// Takes B from the limits, of these dofs, which must stay.
  void setDriven(const Model& model, const ControlLimits& limits, Segments dofs);
  /// Takes R from the cost and M̂, and ∇²ℓ from the cost; M and the cost must stay. Returns false
  /// when M is not positive definite.
  bool setInertia(const Data& data, const GoalCost& cost);

  /// P of the cell in which the rows are kept, after setInertia(). Returns false when it cannot be
  /// factored.
  bool enter(Data& data);
  /// Makes room for so many crossings, after setDriven() and setInertia().
  void reserve(int crossings);
  /// M̂ in the place of P: as if there were no rows.
  void enterWithoutRows() { enterWith(massFactor_); }
  /// What a row that changes its piece does to P⁻¹.
  struct Correction {
    VectorX y, By;       ///< P⁻¹Jᵀ before, Bᵀ y
    VectorX Hy;          ///< ∇²ℓ y; only where K was known
    double scale = 0.0;  ///< γ
  };
  /// Enters the next cell, in which the row J (nv) has `jump` more curvature.
  const Correction& cross(const VectorX& J, double jump);
  /// Whether so many rows have been crossed that it is better to enter() anew.
  bool needsRefactor() const { return correctionCount_ > kMaxCorrections; }
  /// K of this cell, without ℓ_f.
  void computeHessian();
  /// Adds what ℓ_f makes of K in the cell in which `forces` has its Jacobian, until K is computed
  /// anew.
  void addToHessian(ContactForceTerms& forces);

  int columns() const { return static_cast<int>(driven_.size()); }
  bool isFresh() const { return correctionCount_ == 0; }  ///< no row has been crossed
  void select(const VectorX& x, VectorX& y) const;        ///< y ← Bᵀx
  void spread(const VectorX& u, VectorX& tau) const;      ///< tau ← B u where B has entries
  void force(const VectorX& u, VectorX& tau) const;       ///< tau ← B u + given()
  const VectorX& given() const { return givenForce_; }    ///< the force that the box fixes (nv)
  void pick(const VectorX& y, VectorX& u) const;   ///< u ← the driven ones of all coordinates
  void place(const VectorX& u, VectorX& y) const;  ///< y ← u and what the box fixes (nv)
  void controls(const VectorX& tau, VectorX& u) const;  ///< u ← B⁺ tau
  void solve(VectorX& x) const;                         ///< x ← P⁻¹x
  /// y ← Sᵀx and a ← S p, after computeHessian().
  void multiplyTransposed(const VectorX& x, VectorX& y) const;
  void multiply(const VectorX& p, VectorX& a) const {
    for (const Segment s : dofs_)
      part(a, s).noalias() = S_.middleRows(s.begin, s.end - s.begin).leftCols(columns()) * p;
  }
  void multiplyR(const VectorX& x, VectorX& Rx) const;                 ///< Rx ← R x
  const ControlCostTerm& controlCost() const { return controlCost_; }  ///< prepared
  void multiplyControlCost(const VectorX& p, VectorX& y) const;        ///< y ← BᵀR B p
  /// Lower triangle.
  auto hessian() const { return (withForces_ ? forceK_ : K_).topLeftCorner(columns(), columns()); }
  int massFailedRow() const { return massFactor_.failedRow(); }

 private:
  void enterWith(const TreeFactor& factor);
  /// y ← y + Xᵀx, for X (nv × padded).
  void addWeighted(const RowMajorMatrixX& X, const VectorX& x, VectorX& y) const;
  int padded() const { return paddedSize(columns()); }
  void setColumns(RowMajorMatrixX& X);
  void computeControlCost();
  void addToHessian(const Correction& c);

  static constexpr int kMaxCorrections = 16;

  Segments dofs_;
  std::vector<int> driven_;
  std::shared_ptr<const Transmission> transmission_;  ///< null: B selects
  MatrixX B_;                                         ///< empty where B selects
  VectorX fixed_, givenForce_;  ///< coordinates that the box fixes, else 0; the force they make
  TreeFactor massFactor_, cellFactor_;  ///< of M̂, of P
  TreeFactor ownGoalMassFactor_;
  const TreeFactor* goalMassFactor_ = &massFactor_;  ///< of M
  const TreeMatrix* M_ = nullptr;
  const GoalCost* cost_ = nullptr;
  const TreeFactor* factor_ = &cellFactor_;  ///< of P before the corrections
  std::vector<Correction> corrections_;      ///< the first correctionCount_ are in use
  int correctionCount_ = 0;
  int correctionsInS_ = 0;  ///< −1: S is not of this factor
  TreeMatrix P_;
  RowMajorMatrixX S_, rootS_;    ///< S, and scratch of its size
  std::vector<Segment> range_;   ///< columns of a row of L⁻ᵀB that are not zero
  ControlCostTerm controlCost_;  ///< R
  MatrixX reducedControlCost_;   ///< BᵀR B
  MatrixX K_;
  MatrixX forceK_;  ///< K_ with ℓ_f
  bool withForces_ = false;
  VectorX My_, b_;
  mutable VectorX scratch_, padded_;
  VectorX pull_;
};

}  // namespace softgauss::gdd

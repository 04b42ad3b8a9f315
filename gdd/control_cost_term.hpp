// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What force costs: ½ (g − ĝ)ᵀR (g − ĝ) + ½ gᵀW g, with g the generalised force on the dofs
/// (8.1), (8.4).
///
///   R + W = [M⁻¹] + diag(r) + Σ_k d_k d_kᵀ
/// ĝ, 0 unless it is set, is force that costs nothing, such as what holds the robot against gravity
/// (gravity_compensation.hpp). In g the price has the slope (R + W) g − R ĝ. R is M⁻¹ or a matrix
/// that the user gives: a diagonal goes into r, any other as its columns of Cholesky, R = L Lᵀ = Σ
/// l_k l_kᵀ. W is what goals add (9.16): w on a single force adds to r, w on a force along a
/// direction c, ½ w (c·g)², adds the column √w c.

#include <utility>
#include <vector>

#include "softgauss/engine/dynamics/tree_matrix.hpp"
#include "softgauss/gdd/coupled_trees.hpp"

namespace softgauss::gdd {

/// R, a symmetric positive definite matrix on forces. An entry has the unit of an inverse inertia:
/// [1/kg] between two forces, [1/(kg m²)] between two moments.
class ForceMetric {
 public:
  ForceMetric() = default;  ///< M⁻¹
  /// diag(r). Throws ModelError unless every entry is finite and > 0.
  static ForceMetric diagonal(const VectorX& r);
  /// The same in place, without allocation where it is of that size already.
  void setDiagonal(const VectorX& r);
  /// R (nv × nv). Throws ModelError unless it is symmetric and positive definite.
  static ForceMetric dense(const MatrixX& R);

  bool isInverseMass() const { return dofs_ == 0; }
  int dofs() const { return dofs_; }                    ///< nv, 0 where it is M⁻¹
  const VectorX& entries() const { return diagonal_; }  ///< r, empty unless R is diagonal
  const MatrixX& root() const { return root_; }  ///< L with R = L Lᵀ, empty unless R is dense

 private:
  int dofs_ = 0;
  VectorX diagonal_;
  MatrixX root_;
};

class ControlCostTerm {
 public:
  explicit ControlCostTerm(int dofs = 0) : diagonal_(VectorX::Zero(dofs)) {}

  /// R alone, with ĝ = 0. Keeps its memory.
  void set(const ForceMetric& R);
  /// ĝ (nv) [N, N m]. To be called after set().
  void setFree(const VectorX& force);
  /// Adds ½ weight g_dof².
  void add(int dof, double weight) { diagonal_[dof] += weight; }
  /// Adds ½ weight (c·g)².
  void add(const Eigen::Ref<const VectorX>& c, double weight);

  /// R ĝ and ½ ĝᵀR ĝ, for a factor of the M in R, and of its dofs. To be called before freeSlope(),
  /// freeCost() and value().
  void prepare(const TreeFactor& massFactor);

  bool hasInverseMass() const { return inverseMass_; }
  const VectorX& diagonal() const { return diagonal_; }  ///< r (nv)
  int directionCount() const { return count_; }
  auto direction(int k) const { return directions_.col(k); }  ///< d_k (nv)

  /// Appends pairs of bodies whose trees the price couples, but for M⁻¹.
  void appendPairs(const Model& model, std::vector<std::pair<int, int>>& pairs) const;

  /// R + W without M⁻¹ (nv × nv).
  MatrixX dense() const;
  /// Rx ← (R + W) x. `massFactor` is of M̂.
  void multiply(const TreeFactor& massFactor, const VectorX& x, VectorX& Rx) const;
  bool hasFree() const { return hasFree_; }                ///< whether there is a ĝ other than 0
  const VectorX& freeSlope() const { return freeSlope_; }  ///< R ĝ (nv)
  double freeCost() const { return freeCost_; }            ///< ½ ĝᵀR ĝ: what it would cost
  /// The price at g, of which Rg = (R + W) g.
  double value(const VectorX& g, const VectorX& Rg) const {
    return hasFree_ ? 0.5 * g.dot(Rg) - g.dot(freeSlope_) + freeCost_ : 0.5 * g.dot(Rg);
  }

 private:
  bool inverseMass_ = true;
  VectorX diagonal_;
  MatrixX directions_;  ///< (nv × room), the first count_ columns are in use
  int count_ = 0;
  VectorX metric_;            ///< of diagonal_ what is of R, or empty
  int metricDirections_ = 0;  ///< of directions_ those of R
  bool hasFree_ = false;
  VectorX free_;          ///< ĝ (nv)
  VectorX freeExplicit_;  ///< (R − [M⁻¹]) ĝ (nv)
  VectorX freeSlope_, scratch_;
  double freeCost_ = 0.0;
};

}  // namespace softgauss::gdd

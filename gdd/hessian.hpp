// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The Gauss–Newton Hessian of (10.2), for R = M⁻¹ assembled without an n³ product:
///
///   H = P M⁻¹ P + P ψ″ P + ∇²ℓ,   P = M + G,   G = Jᵀ∇²s J
///   P M⁻¹ P = M + 2 G + Cᵀ D⁻¹ C,   C = L⁻ᵀ G,   M = LᵀDL                              (10.4)
///
/// C is non-zero only at the dofs that active rows move, and P ψ″ P has one rank-one term for each
/// bound that is in force, of a coordinate y_i = C_i g the term P C_iᵀ ψ″ C_i P. Prices of forces
/// are such terms too, and so is any other R, column by column (control_cost_term.hpp).

#include <vector>

#include "softgauss/engine/step/data.hpp"
#include "softgauss/gdd/cost.hpp"
#include "softgauss/gdd/problem.hpp"

namespace softgauss::gdd {

class GaussNewtonHessian {
 public:
  explicit GaussNewtonHessian(const Model& model);
  GaussNewtonHessian(const GaussNewtonHessian&) = delete;  // H points at dense_
  GaussNewtonHessian& operator=(const GaussNewtonHessian&) = delete;

  /// G and P = M̂ + G of the cell in which the rows were last evaluated.
  void setCell(Data& data);
  /// Factors H, with ∇²ℓ of contact forces in this cell. `massFactor` is of M̂, `boundCurvature` ψ″
  /// of every coordinate. Returns false when H is not positive definite, rounding apart.
  bool factorize(const Data& data, const TreeFactor& massFactor, const VectorX& boundCurvature,
                 const ControlLimits& limits, GoalCost& cost, ContactForceTerms& forces);
  /// x ← H⁻¹ x.
  void solve(VectorX& x) const { factor_.solve(x); }
  /// y ← P x.
  void multiplyP(const VectorX& x, VectorX& y) const { P_.multiply(x, y); }

 private:
  void addReflectedContacts(const Data& data, const TreeFactor& massFactor);
  bool factorizeRounded();
  void addForceTerms(const VectorX& boundCurvature, const ControlLimits& limits,
                     const ControlCostTerm& controlCost);
  void addForceRow(int dof, double curvature);
  void addForceRow(const Eigen::Ref<const VectorX>& force, double curvature);

  TreeMatrix P_, G_;
  TreeSparsity dense_;  ///< all dofs coupled
  TreeMatrix H_;
  TreeFactor factor_;
  std::vector<int> touched_;  ///< dofs that active rows move, ascending
  std::vector<int> compact_;  ///< dof → place in touched_, or −1
  std::vector<double> C_;     ///< rows of length touched_.size()
  std::vector<double> gram_;
  std::vector<double> forceRows_;  ///< √ψ″ C_i P and the like, each of length n
  VectorX force_, row_;
};

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How inverse dynamics g(q, v, a) (1.2) changes: ∂g/∂q, ∂g/∂v, and ∂g/∂a = P (1.3).
///
/// Analytic for the tree (D.4), springs, damping and wrenches, limits and dry friction (D.5), and
/// contacts (D.8), of shapes without a closed form by differences of where they touch
/// (pair_differences.hpp); central differences of their rows alone for equality constraints
/// (row_differences.hpp). q changes by its tangent, as
/// integratePosition() takes it: g(q ⊕ δ) = g(q) + Gq δ.
///
/// g is smooth but for kinks: breakpoints of penalties, where a contact begins or breaks, sticks or
/// slides, a limit is reached, dry friction slips. There these are the derivatives of the side on
/// which the rows are, breakpoints as free ones. Loads that contacts carry, margins that follow
/// speeds, and a₋ of State::a, are constants.

#include "softgauss/engine/constraints/derivative/contact_derivative.hpp"
#include "softgauss/engine/constraints/derivative/scalar_row_derivative.hpp"
#include "softgauss/engine/dynamics/rnea_derivative.hpp"
#include "softgauss/engine/step/data.hpp"
#include "softgauss/engine/step/pair_differences.hpp"
#include "softgauss/engine/step/row_differences.hpp"

namespace softgauss {

class InverseDerivative {
 public:
  explicit InverseDerivative(const Model& model);

  /// At a (nv) and the state, of which `data` holds the stages that computeStages() made with this
  /// input and these contacts (null: nothing collides). Leaves the rows evaluated at a. Returns
  /// badInput and notFinite as inverseDynamics() does; the derivatives are then as they were.
  SolveStatus compute(const Model& model, const Input& input, const State& state, const VectorX& a,
                      ContactSource* contacts, Data& data);

  const MatrixX& q() const { return q_; }        ///< ∂g/∂q (nv × nv) [N, N m per m, rad]
  const MatrixX& v() const { return v_; }        ///< ∂g/∂v (nv × nv) [N, N m per m/s, rad/s]
  const TreeMatrix& a() const { return P_; }     ///< ∂g/∂a = P (nv × nv)
  const VectorX& force() const { return tau_; }  ///< g(q, v, a) (nv) [N, N m]

 private:
  void addSmooth(const Model& model, const Input& input, const VectorX& a, const Data& data);

  RneaDerivative tree_;
  ScalarRowDerivative scalars_;
  ContactDerivative contacts_;
  PairDifferences pairs_;
  RowDifferences differences_;
  SupportedMass load_;
  MatrixX q_, v_;
  TreeMatrix P_;
  VectorX tau_;
};

}  // namespace softgauss

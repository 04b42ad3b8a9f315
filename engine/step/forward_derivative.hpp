// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How forward dynamics and the step change, by the implicit function theorem: g(q, v, a) = τ holds
/// at the solution, so that with ∂g of inverse_derivative.hpp
///
///   ∂a/∂q = −P⁻¹ ∂g/∂q,   ∂a/∂v = −P⁻¹ ∂g/∂v,   ∂a/∂τ = P⁻¹                               (D.9)
///
/// a is continuous in all three, and at a kink has the derivative of the side on which its rows
/// are; on the other side it has another one. P holds every curvature that acts, so that the
/// derivatives are bounded at any contact: as large as the contact is stiff.

#include <Eigen/Cholesky>

#include "softgauss/engine/step/inverse_derivative.hpp"
#include "softgauss/engine/step/transition.hpp"

namespace softgauss {

class ForwardDerivative {
 public:
  explicit ForwardDerivative(const Model& model);

  /// At data.forward.a, which forwardDynamics() has found from the stages of `state` in `data`.
  /// Leaves the rows evaluated there. notFinite where P is not positive.
  SolveStatus compute(const Model& model, const Input& input, const State& state,
                      ContactSource* contacts, Data& data);

  const MatrixX& q() const { return q_; }      ///< ∂a/∂q (nv × nv)
  const MatrixX& v() const { return v_; }      ///< ∂a/∂v (nv × nv)
  const MatrixX& tau() const { return tau_; }  ///< ∂a/∂τ (nv × nv), symmetric
  const InverseDerivative& inverse() const { return inverse_; }

 private:
  InverseDerivative inverse_;
  TreeFactor factor_;
  VectorX column_;
  MatrixX q_, v_, tau_;
};

/// Of one bare step of the leapfrog: without what divides steps (substepping, treeSubstepping) and
/// without a velocity of turning predicted from the last step (midpointVelocity), so that (q, v) is
/// all its state.
class StepDerivative {
 public:
  explicit StepDerivative(const Model& model);

  /// The options of a model whose step is bare: `options` as a leapfrog without those mechanisms.
  static Options bareStep(Options options);

  /// At the state where the step begins, with the force that input.tau has and forward dynamics
  /// solved here. Throws ModelError where the model's step is not bare. `state` stays.
  SolveStatus compute(const Model& model, const Input& input, const State& state,
                      ContactSource* contacts, Data& data);

  const MatrixX& state() const { return x_; }  ///< ∂(q⁺, v⁺)/∂(q, v) (2 nv × 2 nv), by tangents
  const MatrixX& tau() const { return tau_; }         ///< ∂(q⁺, v⁺)/∂τ (2 nv × nv)
  const VectorX& acceleration() const { return a_; }  ///< of the step (nv)

 private:
  ForwardDerivative forward_;
  Transition transition_;
  State middle_;
  VectorX a_;
  MatrixX q_, v_, x_, tau_;
};

}  // namespace softgauss

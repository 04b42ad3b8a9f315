// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The greedy goal of a value function that is quadratic about a state: equation (22) of the paper.
///
///   ℓ(a) = V(q⁺, v⁺),   V(x) = s·e + ½ eᵀH e,   e = (q ⊖ q̄, v − v̄)                        (P.8)
///
/// with the state at the step's end by (P.7). ℓ is quadratic where nothing floats; else it is
/// expanded about the acceleration `about`: with e and B there, and J_e = J_r⁻¹(e) of rotations,
///
///   LᵀL = BᵀJ_eᵀH J_e B,   y = L ā − L⁻ᵀBᵀJ_eᵀ(s + H e),   ℓ(a) = ½ |L a − y|² + const
///
/// LᵀL is raised by 1e-10 of its mean diagonal, lest a slope in a direction that H does not weigh
/// has no minimum.

#include <Eigen/Cholesky>

#include "softgauss/gdd/next_state.hpp"

namespace softgauss::gdd {

class QuadraticValue final : public Goal {
 public:
  VectorX q;          ///< q̄ (nq)
  VectorX v;          ///< v̄ (nv)
  VectorX slope;      ///< s (2 nv)
  MatrixX curvature;  ///< H (2 nv × 2 nv), symmetric, no eigenvalue below 0
  VectorX about;      ///< ā (nv); empty: the solution of the last step, or 0
  /// ĝ (nv) from which the control cost counts (8.4), in place of the controller's; empty: as it
  /// is.
  VectorX freeControl;
  double timestep = 0.0;  ///< of the step that V is the value after [s]; 0: the model's

  /// V = 0 about the model's initial state.
  explicit QuadraticValue(const Model& model);
  std::string name() const override { return "value"; }
  /// Throws nothing; a V that is not finite, or an H that is not as it is to be, adds a cost that
  /// is not finite, and the solve refuses it.
  void addCost(const GoalContext& context, GoalCost& cost) const override;

 private:
  /// What addCost() writes to, kept so that it allocates once.
  struct Work {
    NextState next;
    VectorX a, difference, e, s, y, down;
    MatrixX H, once, K, L;
    Eigen::LLT<MatrixX> factor;
  };
  mutable Work work_;
};

}  // namespace softgauss::gdd

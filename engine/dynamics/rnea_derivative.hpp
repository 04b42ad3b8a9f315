// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How inverse dynamics of the tree, τ = M a + b (2.2), changes with q and v.
///
/// With (D.1), B of (2.9), and A of all bodies with gravity, −g at the world, let for each dof j
/// of body b that moves against λ
///
///   d_j = V_λ × S_j,   c_j = A_λ × S_j + V_λ × d_j
///   T_j = I^c_b c_j + B^c_b d_j,   R_j = T_j + S_j ×* F^c_b        F^c: force of the subtree
///
///   ∂τ_i/∂q_j = S_i · (I^c_k c_j + B^c_k d_j)     j at or above i, k the body of i         (D.4)
///             = S_i · R_j                         j below i
///             = S_i · T_j                         both rotations of one floating joint
///   ∂τ/∂v     = C of (2.9)
///
/// O(Σ depth) in all (Carpentier and Mansard, "Analytical derivatives of rigid body dynamics
/// algorithms", 2018; in this form after Singh, Russell and Wensing 2022).

#include "softgauss/engine/dynamics/coriolis_matrix.hpp"
#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

class RneaDerivative {
 public:
  explicit RneaDerivative(const Model& model);

  /// Gq ← Gq + ∂τ/∂q and Gv ← Gv + ∂τ/∂v (nv × nv) at the acceleration a (nv) and the velocity of
  /// turning, with gravity and Coriolis forces as options.effects has them. q by its tangent, as
  /// integratePosition() takes it.
  void addTo(const Model& model, const Kinematics& kinematics, const MassMatrix& inertia,
             const VectorX& a, MatrixX& Gq, MatrixX& Gv);

 private:
  /// V, A, F^c and B^c of all bodies.
  void sweep(const Model& model, const Kinematics& k, const MassMatrix& inertia, const VectorX& a);

  VectorX v_;               ///< (nv) translations of floating joints as they turn
  std::vector<Matrix6> B_;  ///< (bodies) B^c
  std::vector<Motion> V_, A_;
  std::vector<Force> F_;           ///< (bodies) F^c
  std::vector<Motion> c_, d_, E_;  ///< (nv)
};

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How the Coriolis and gyroscopic forces change with the velocity: C = ∂b(q, v)/∂v (nv × nv).
///
/// The force of body b is F_b = I_b A_b + V_b ×* I_b V_b. With δV_b = S_j and
/// δA_b = E_j − V_b × S_j for a change of v_j, j at or above b,
///
///   C_ij = S_i · (I^c_k E_j + B^c_k S_j),   k the deeper one of the bodies of i and j
///   B_b = V_b ×* I_b − I_b V_b × + (I_b V_b) ×̄*,   E_j = ∂A_j/∂v_j + V_j × S_j            (2.9)
///
/// ×̄* is the same product as ×*, as a matrix on its left factor; ᶜ sums over the subtree. C is not
/// symmetric, and has entries only where i is at or above j or below it (after Echeandia and
/// Wensing 2021, and Singh, Russell and Wensing 2022). O(Σ depth).

#include <vector>

#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

/// A matrix whose entries are on the pattern of a kinematic tree on both sides of the diagonal.
struct TreePair {
  TreeMatrix lower;  ///< row i: A_ij of dofs j at or above i
  TreeMatrix upper;  ///< row i: A_ji of dofs j above i
};

class CoriolisDerivative {
 public:
  CoriolisDerivative() = default;
  explicit CoriolisDerivative(const Model& model)
      : B_(model.bodies.size()), E_(model.dofs.size()), P_(model.dofs.size()) {}

  /// A ← M + scale · C at the velocity of `kinematics`.
  void addTo(const Model& model, const Kinematics& kinematics, const MassMatrix& inertia,
             double scale, TreePair& A);

 private:
  std::vector<Matrix6> B_;  ///< (bodies) B^c
  std::vector<Motion> E_;   ///< (nv)
  std::vector<Force> P_;    ///< (nv) I^c E + B^c S
};

}  // namespace softgauss

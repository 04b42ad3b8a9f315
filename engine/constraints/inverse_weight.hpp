// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Constant inverse inertias that scale the regulariser of every row (2.7).
///
/// Computed once with all joints at Body::reference, zero for most, as MuJoCo does it, or, where
/// the mass matrix is singular there, in Model::q0; armature included: for a body the mean of the
/// diagonal of J M⁻¹ Jᵀ over the three translations, and over the three rotations, of its centre of
/// mass; for a dof the diagonal of M⁻¹ (for a floating joint the mean of three).

#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss {

struct InverseWeights {
  std::vector<double> translation;  ///< (bodies) [1/kg]; 0 for the world
  std::vector<double> rotation;     ///< (bodies) [1/(kg m²)]
  std::vector<double> dof;          ///< (nv)
  /// Of both bodies of a tie together, at Connection::centers and Weld::centers [1/kg].
  std::vector<double> connection, weld;

  InverseWeights() = default;
  /// Throws ModelError when the mass matrix is singular in both.
  explicit InverseWeights(const Model& model);
};

}  // namespace softgauss

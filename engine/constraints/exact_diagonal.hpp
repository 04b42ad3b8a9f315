// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The regulariser from the inverse inertia that rows have now, in place of constants of the model.
///
/// R = (1 − d)/d A of (3.1) takes A from the inverse weights (2.7). With Options::exactDiagonal
/// it is the diagonal of J M⁻¹ Jᵀ at the present configuration, a triangular solve for each row.
/// All edges of a friction pyramid take the A of the first one, all rows of an elliptic cone that
/// of the normal; contact springs have no A. That is MuJoCo's `diagexact`, but for rows along which
/// nothing moves: R keeps 10⁻⁹ of its constant.

#include "softgauss/engine/constraints/constraints.hpp"
#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

class ExactDiagonal {
 public:
  explicit ExactDiagonal(int dofs) : row_(VectorX::Zero(dofs)), solved_(VectorX::Zero(dofs)) {}

  /// Rescales the stiffness of all rows; false where M is not positive definite.
  bool apply(const TreeMatrix& M, Constraints& constraints);

 private:
  TreeFactor factor_;  ///< of M
  VectorX row_, solved_;
};

}  // namespace softgauss

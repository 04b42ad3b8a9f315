// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How forces of rows without a closed form change with q and v: central differences of those rows
/// alone, which move bodies and make the rows again, and nothing else.
///
/// So are equality constraints and geometric stiffness, which look at the inertia of what they
/// carry. Models without these pay nothing; others some 4 nv times the making of these rows.

#include "softgauss/engine/constraints/constraints.hpp"

namespace softgauss {

class RowDifferences {
 public:
  RowDifferences(const Model& model, RowKinds planned);

  /// Adds to ∂g/∂q and ∂g/∂v (nv × nv) at a the part of these rows. in.load is what contacts carry.
  void addTo(const Assembly& in, const VectorX& a, MatrixX& Gq, MatrixX& Gv);

 private:
  /// −Jᵀf of these rows at a, with q and v of state_.
  void force(const Assembly& in, const VectorX& a, VectorX& tau);

  State state_;
  VectorX midstep_, along_, more_, less_;
  Kinematics kinematics_;
  Constraints equalities_;
};

}  // namespace softgauss

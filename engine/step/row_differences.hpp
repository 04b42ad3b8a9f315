// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How forces of rows without a closed form change with q and v: central differences of those rows
/// alone, which move bodies and make the rows again, and nothing else.
///
/// So are equality constraints and geometric stiffness, which look at the inertia of what they
/// carry, and contacts of pairs of shapes that are not in contact_shift.hpp: their places follow
/// the detection. Models without these pay nothing; others some 4 nv times the making of these
/// rows.

#include <span>
#include <utility>
#include <vector>

#include "softgauss/engine/constraints/constraints.hpp"
#include "softgauss/engine/step/contact_source.hpp"

namespace softgauss {

class RowDifferences {
 public:
  RowDifferences(const Model& model, RowKinds planned);

  /// Adds to ∂g/∂q and ∂g/∂v (nv × nv) at a the part of equality constraints and of contacts
  /// between `pairs` of geometries, which `contacts` finds. in.load is what contacts carry.
  void addTo(const Assembly& in, const VectorX& a, std::span<const std::pair<int, int>> pairs,
             ContactSource* contacts, MatrixX& Gq, MatrixX& Gv);

 private:
  /// −Jᵀf of these rows at a, with q and v of state_.
  void force(const Assembly& in, const VectorX& a, ContactSource* contacts, VectorX& tau);

  State state_;
  VectorX midstep_, along_, more_, less_;
  Kinematics kinematics_;
  ContactSet found_, kept_;
  std::span<const std::pair<int, int>> pairs_;
  Constraints equalities_;
  PyramidalContact pyramid_;
  EllipticContact cone_;
};

}  // namespace softgauss

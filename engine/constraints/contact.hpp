// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Frictional contact with a pyramidal cone, and frictionless contact.
///
/// At a contact of distance r with normal n (from A to B) and tangents t₁, t₂, let
/// y = [n t₁ t₂]ᵀ(J_B − J_A) a be the relative acceleration of the touching points less its bias
/// J̇ v. The rows are the edges of the friction pyramid (T.14):
///   x = (y_n ± μ y_k) − a_ref,   a_ref = −b (ẏ_n ± μ ẏ_k) − k d (r − margin),   k = 1, 2
///   s(x) = ½ D min(x, 0)²,       D = impratio/(2 μ² R₀),   R₀ = (1 − d)/d (w_A + w_B)(1 + μ²)
/// with w the bodies' translational inverse weights. Edge forces f ≥ 0 add up to
///   f_n = Σ f,   f_k = μ (f₊ − f₋),   so |f₁| + |f₂| ≤ μ f_n whatever the acceleration.
/// condim 1, or μ below 10⁻⁵: the one row x = y_n − a_ref with R = (1 − d)/d (w_A + w_B).

#include <vector>

#include "engine/constraints/assembly.hpp"
#include "engine/constraints/block_jacobian.hpp"
#include "engine/constraints/rows.hpp"

namespace softgauss {

/// Surface parameters of a pair (T.15): condim and frictions are the larger of the two, impedance
/// parameters their mean, margins the sum.
Material mixMaterials(const Material& a, const Material& b);

/// A contact that made rows.
struct ContactRows {
  int contact = 0;      ///< index into ContactSet::contacts
  int row = 0;          ///< first row
  double friction = 0;  ///< μ, 0 when frictionless
  Matrix3 R_WC;         ///< columns n, t₁, t₂
};

class PyramidalContact : public ScalarRows<HalfQuadratic> {
 public:
  void assemble(const Assembly& in);
  void multiply(const VectorX& a, std::vector<double>& y) const;
  void addForce(VectorX& tau) const;
  void addCurvature(TreeMatrix& P);
  /// y ← y + scale · (row i of J)ᵀ.
  void addRow(int i, double scale, VectorX& y) const;
  void appendCouplings(std::vector<Segment>& segments, std::vector<int>& setEnd) const {
    jacobian_.appendCouplings(segments, setEnd);
  }

  /// Contacts with rows; contact i starts at row made()[i].row.
  const std::vector<ContactRows>& made() const { return made_; }
  /// Force on body B at contact i, world [N]; body A feels the opposite.
  Vector3 force(int i) const;

 private:
  BlockJacobian jacobian_;  ///< block i: (n, t₁, t₂) of contact i, or n alone
  std::vector<ContactRows> made_;
  std::vector<int> contactOfRow_;
};

}  // namespace softgauss

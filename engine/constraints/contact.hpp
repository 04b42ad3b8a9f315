// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Frictional contact with a pyramidal cone, and frictionless contact.
///
/// At a contact of distance r with normal n (from A to B) and tangents t₁, t₂, let y be the
/// relative acceleration of the touching bodies less its bias J̇ v: y_n, y₁, y₂ that of the touching
/// points along n, t₁, t₂, and, with condim 4 and 6, the angular y₃, y₄, y₅ about n, t₁, t₂. The
/// rows are the edges of the friction pyramid (T.14):
///   x = (y_n ± μ_k y_k) − a_ref,   a_ref = −b (ẏ_n ± μ_k ẏ_k) − k d (r − margin),  k = 1 … condim
///   − 1 s(x) = ½ D min(x, 0)²,         D = impratio/(2 μ² R₀),   R₀ = (1 − d)/d (w_A + w_B)(1 +
///   μ²)
/// with w the bodies' translational inverse weights, μ₁ = μ₂ = μ [-] of sliding, μ₃ [m] of
/// torsional and μ₄ = μ₅ [m] of rolling friction. Edge forces f ≥ 0 add up to
///   f_n = Σ f,   f_k = μ_k (f₊ − f₋),   so Σ |f_k|/μ_k ≤ f_n whatever the acceleration.
/// condim 1, or μ below 10⁻⁵: the one row x = y_n − a_ref with R = (1 − d)/d (w_A + w_B).

#include <array>
#include <vector>

#include "engine/constraints/assembly.hpp"
#include "engine/constraints/block_jacobian.hpp"
#include "engine/constraints/rows.hpp"

namespace softgauss {

/// Surface parameters of a pair (T.15): condim and frictions are the larger of the two, impedance
/// parameters their mean, margins the sum.
Material mixMaterials(const Material& a, const Material& b);

/// The surface of a pair of geometries: its own, or the mix of theirs.
Material pairMaterial(const Model& model, int geometryA, int geometryB);

/// A contact that made rows.
struct ContactRows {
  int contact = 0;                    ///< index into ContactSet::contacts
  int row = 0;                        ///< first row
  double friction = 0;                ///< μ, 0 when frictionless
  Matrix3 R_WC;                       ///< columns n, t₁, t₂
  int pairs = 0;                      ///< pairs of edges: condim − 1; 0: one row
  std::array<double, 5> frictions{};  ///< μ_k of each pair
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
  /// Moment on body B at contact i, of torsional and rolling friction, world [N m]; body A feels
  /// the opposite.
  Vector3 moment(int i) const;

 private:
  /// Forces and moments of contact i in its frame: (f_n, f₁ … f_{condim − 1}).
  void frameForce(int i, double* frame) const;

  BlockJacobian jacobian_;  ///< block i: y of contact i
  std::vector<ContactRows> made_;
  std::vector<int> contactOfRow_;
};

}  // namespace softgauss

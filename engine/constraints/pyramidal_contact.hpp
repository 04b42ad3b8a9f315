// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Frictional contact with a pyramidal cone, and frictionless contact.
///
/// The rows of a contact are the edges of its friction pyramid (4.7):
///   x = (y_n ± μ_k y_k) − a_ref,   a_ref = −b (ẏ_n ± μ_k ẏ_k) − k d r,   k = 1 … condim − 1,
///   less (1 − lag b) J̇ v of the edge
///   s(x) = ½ D min(x, 0)²,         D = impratio/(2 μ² R₀),   R₀ = (1 − d)/d (w_A + w_B)(1 + μ²)
/// with w the bodies' translational inverse weights. Edge forces f ≥ 0 add up to
///   f_n = Σ f,   f_k = μ_k (f₊ − f₋),   so Σ |f_k|/μ_k ≤ f_n whatever the acceleration.
/// A contact without friction has the one row x = y_n − a_ref with R = (1 − d)/d (w_A + w_B).

#include "softgauss/engine/constraints/contact.hpp"
#include "softgauss/engine/constraints/rows.hpp"

namespace softgauss {

class PyramidalContact : public ScalarRows<HalfQuadratic>, public ContactBlocks {
 public:
  static constexpr Cone kCone = Cone::pyramidal;

  void assemble(const Assembly& in);
  /// The same of one contact alone, the first of `in`, which touches so.
  void assembleOne(const Assembly& in, const PairSurface& pair, const Touch& touch) {
    begin();
    add(in, 0, pair, touch);
    finish();
  }
  void addColumns(const Model& model, const Kinematics& k, const TreeSparsity& tree) {
    forEachContact(selection, [&](int i) { jacobian_.addColumns(model, k, tree, i); });
  }
  /// `Acceleration`, `Forces`, `Curvature`: as BlockJacobian takes them.
  template <class Acceleration>
  void multiply(const Acceleration& a, std::vector<double>& y) const;
  template <class Forces>
  void addTransposed(const std::vector<double>& y, Forces& tau) const;
  template <class Curvature>
  void addCurvature(Curvature& P);
  /// y ← y + scale · (row i of J)ᵀ.
  void addRow(int i, double scale, VectorX& y) const;

  /// Force on body B at contact i, world [N]; body A feels the opposite.
  Vector3 force(int i) const { return linearInWorld(i, inFrame(i, f)); }
  /// Moment on body B at contact i, of torsional and rolling friction, world [N m]; body A feels
  /// the opposite.
  Vector3 moment(int i) const { return angularInWorld(i, inFrame(i, f)); }

  std::size_t bytes() const { return ScalarRows::bytes() + ContactBlocks::bytes(); }
  /// The force at contact i in its frame.
  FrameVector frameForce(int i) const { return inFrame(i, f); }
  /// Its rate along the search direction, after setForceRate().
  FrameVector frameForceRate(int i) const { return inFrame(i, df); }
  /// H ← ∇²s of contact i in its frame (dim × dim, row-major), so that ∂(frame force)/∂a = −H J.
  /// Returns dim.
  int frameCurvature(int i, double* H) const;
  /// A row in the frame of its contact: x = row · y − a_ref, and the same of its breakpoint.
  FrameVector breakpointInFrame(int row, int breakpoint) const;

 private:
  void begin();
  void add(const Assembly& in, int i, const PairSurface& pair, const Touch& touch);
  void finish();
  /// scale · row of J, by the frame of its contact.
  FrameVector rowInFrame(int row, double scale) const;
  /// Sum over the edges of contact i of `y` times the edge.
  FrameVector inFrame(int i, const std::vector<double>& y) const;
};

}  // namespace softgauss

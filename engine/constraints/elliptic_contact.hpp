// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Frictional contact with an elliptic cone.
///
/// The rows of a contact are its condim directions themselves (4.13):
///   x = y − a_ref,   a_ref = (−b ẏ_n − k d r, −b ẏ₁, …, −b ẏ_{condim − 1}) − (1 − lag b) J̇ v
///   D = d/((1 − d)(w_A + w_B)) of the normal row,   μ̂ = μ/√impratio
/// and their penalty is that of elliptic_cone.hpp. Normal softness does not depend on friction.

#include "softgauss/engine/constraints/contact.hpp"
#include "softgauss/engine/constraints/elliptic_cone.hpp"
#include "softgauss/engine/constraints/rows.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss {

class EllipticContact : public ContactBlocks {
 public:
  static constexpr Cone kCone = Cone::elliptic;

  std::vector<double> reference;  ///< a_ref
  std::vector<double> x;          ///< residual at the present acceleration
  std::vector<double> dx;         ///< J d
  std::vector<double> f;          ///< force −∇s(x)
  std::vector<double> df;         ///< rate of f along the search direction
  RowSelection selection;         ///< what the solver walks

  int rowCount() const { return static_cast<int>(x.size()); }
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
  double evaluate(bool& cellChanged);
  void along(double alpha, Jet& sum) const;
  /// A cone bends.
  bool staysInCell() const { return selection.count() == 0; }
  void advance(double alpha);
  void setForceRate();  ///< df ← −∇²s(x) dx
  template <class Forces>
  void addTransposed(const std::vector<double>& y, Forces& tau) const;
  template <class Curvature>
  void addCurvature(Curvature& P);
  void addRow(int i, double scale, VectorX& y) const;

  // Breakpoints, where a contact changes its zone (elliptic_cone.hpp). Their row is the contact's
  // first.
  void findCrossings(int kind, std::vector<Crossing>& crossings) const;
  double aboveBreakpoint(int row, int breakpoint) const;
  double curvatureJump(int row, int breakpoint) const;
  /// y ← y + scale · Jᵀ∇(what vanishes at the breakpoint).
  void addBreakpointGradient(int row, int breakpoint, double scale, VectorX& y) const;
  /// The contact counts as in the zone above the breakpoint, or below it on the stiff side,
  /// wherever it is, until clearBreakpointPlacement().
  void placeAtBreakpoint(int row, int breakpoint, bool stiffSide);
  void clearBreakpointPlacement() { placed_.assign(placed_.size(), false); }
  void holdOnRay(int) {}

  const EllipticCone& cone(int i) const { return cones_[idx(i)]; }
  /// Softness::perInertia of contact i, and D of its normal row, which scales its other rows too.
  double perInertia(int i) const { return perInertia_[idx(i)]; }
  void setNormalStiffness(int i, double D) { cones_[idx(i)].D = D; }
  /// Force on body B at contact i, world [N]; body A feels the opposite.
  Vector3 force(int i) const { return linearInWorld(i, frameForce(i)); }
  /// Moment on body B at contact i, of torsional and rolling friction, world [N m]; body A feels
  /// the opposite.
  Vector3 moment(int i) const { return angularInWorld(i, frameForce(i)); }

  FrameVector frameForce(int i) const;
  std::size_t bytes() const {
    return ContactBlocks::bytes() + selection.bytes() +
           bytesOfAll(reference, x, dx, f, df, cones_, perInertia_, zones_, placed_);
  }
  /// Its rate along the search direction, after setForceRate().
  FrameVector frameForceRate(int i) const;
  /// H ← ∇²s of contact i in its frame (dim × dim, row-major), so that ∂(frame force)/∂a = −H J.
  /// Returns dim.
  int frameCurvature(int i, double* H) const;
  /// Gradient of what vanishes at the breakpoint, in the frame of the contact.
  FrameVector breakpointInFrame(int row, int breakpoint) const;

 private:
  void begin();
  void add(const Assembly& in, int i, const PairSurface& pair, const Touch& touch);
  void finish();
  /// Penalty of contact i at x; where it is not placed, `zone` is that of x.
  double evaluate(std::size_t i, const double* at, double* force, double* H, ConeZone& zone) const;

  std::vector<EllipticCone> cones_;
  std::vector<double> perInertia_;
  std::vector<ConeZone> zones_;  ///< of the last evaluation
  std::vector<bool> placed_;     ///< zones_[i] holds wherever x is
};

}  // namespace softgauss

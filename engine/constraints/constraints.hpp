// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Every soft constraint of the engine, and the operations that run over all of them:
///   s(Ja − r) of the extended Gauss principle (T.1), its force −Jᵀ∇s and curvature Jᵀ∇²s J.
///
/// To add an effect: write its file, add a member, name it in visit(). A kind without rows costs
/// an empty loop.

#include <concepts>
#include <optional>
#include <vector>

#include "engine/constraints/connection.hpp"
#include "engine/constraints/dry_friction.hpp"
#include "engine/constraints/elliptic_contact.hpp"
#include "engine/constraints/joint_coupling.hpp"
#include "engine/constraints/joint_limit.hpp"
#include "engine/constraints/pyramidal_contact.hpp"
#include "engine/constraints/weld.hpp"

namespace softgauss {

template <class C>
concept SoftConstraint = requires(C c, const Assembly& in, const VectorX& a, VectorX& tau,
                                  std::vector<double>& y, TreeMatrix& P, bool& changed, Jet& jet,
                                  std::vector<Crossing>& crossings) {
  { c.rowCount() } -> std::convertible_to<int>;
  c.assemble(in);                                          // rows, a_ref, D
  c.multiply(a, y);                                        // y = J a
  { c.evaluate(changed) } -> std::convertible_to<double>;  // cost; force, curvature
  c.along(0.0, jet);                                       // derivatives along a ray
  c.advance(0.0);                                          // x += α dx
  c.setForceRate();                                        // df ← −∇²s dx
  c.addTransposed(y, tau);                                 // tau += Jᵀ y
  c.addCurvature(P);                                       // P += Jᵀ ∇²s J
  c.addRow(0, 1.0, tau);                                   // tau += scale · (row of J)ᵀ
  c.findCrossings(0, crossings);                           // knots along a ray
  { c.aboveKnot(0, 0) } -> std::convertible_to<double>;
  { c.curvatureJump(0, 0) } -> std::convertible_to<double>;
  c.placeAtKnot(0, 0, true);
  c.holdOnRay(0);
};

class Constraints {
 public:
  ConnectionRows connection;
  WeldRows weld;
  CouplingRows coupling;
  DryFriction dryFriction;
  JointLimit jointLimit;
  PyramidalContact contact;
  EllipticContact ellipticContact;

  template <class F>
  void visitAllButContacts(F&& f) {
    f(connection);
    f(weld);
    f(coupling);
    f(dryFriction);
    f(jointLimit);
  }
  template <class F>
  void visitAllButContacts(F&& f) const {
    f(connection);
    f(weld);
    f(coupling);
    f(dryFriction);
    f(jointLimit);
  }
  template <class F>
  void visit(F&& f) {
    visitAllButContacts(f);
    f(contact);
    f(ellipticContact);
  }
  template <class F>
  void visit(F&& f) const {
    visitAllButContacts(f);
    f(contact);
    f(ellipticContact);
  }

  void assemble(const Assembly& in);
  int rowCount() const;
  /// Pattern of P = M + Jᵀ∇²s J: the trees', or with fill-in where rows couple branches.
  const TreeSparsity& sparsity() const { return *sparsity_; }

  /// x ← J a − a_ref.
  void setResidual(const VectorX& a);
  /// dx ← J d.
  void setRay(const VectorX& d);
  /// Forces and curvatures at x; returns the cost s(x) and whether any row changed its piece.
  double evaluate(bool& cellChanged);
  /// Adds the derivatives of s(x + α dx) in α.
  void along(double alpha, Jet& jet) const;
  void advance(double alpha);
  void addForce(VectorX& tau) const;
  /// Adds the rate of that force along the ray, −Jᵀ∇²s dx, at the present residual.
  void addForceRate(VectorX& tau);
  void addCurvature(TreeMatrix& P);
  /// Whether s is a sum of piecewise quadratics at present, so that findCrossings() is complete.
  bool piecewiseQuadratic() const { return ellipticContact.rowCount() == 0; }
  /// All knots ahead on the ray, α ≥ 0, unordered.
  void findCrossings(std::vector<Crossing>& crossings) const;
  /// The first knot ahead on the ray, counted from the pieces in which the rows are kept; alpha = ∞
  /// if there is none. Only where s is piecewise quadratic.
  Crossing nextCrossing() const;
  /// Puts a row at a knot, in the piece above it or the one below.
  void enterPiece(Knot knot, bool above);
  bool isAbove(Knot knot) const;
  /// Forces and curvatures at x with every row in the piece in which it is kept.
  void evaluateInPlace();
  /// y ← y + scale · (row of J)ᵀ.
  void addRow(RowId id, double scale, VectorX& y) const;
  /// How far the row is above its knot: x less x there, or what takes its place on a cone.
  double aboveKnot(Knot knot) const;
  /// y ← the gradient in a of that distance.
  void knotGradient(Knot knot, VectorX& y) const;
  /// s″ above a knot less s″ below it.
  double curvatureJump(Knot knot) const;
  /// The name by which find() has the knot again in a later step.
  KnotName nameOf(Knot knot) const;
  /// The knot of that name; nothing where its row does not exist now.
  std::optional<Knot> find(const KnotName& name) const;
  /// Puts the row exactly at its knot, where it is free, or next to it on the stiff side.
  void placeAtKnot(Knot knot, bool stiffSide);
  /// Takes a row off the ray.
  void holdOnRay(RowId id);
  /// (rows × nv) J, dense; allocates.
  MatrixX denseJacobian() const;

 private:
  /// Calls f with the effect of a row.
  template <class Self, class F>
  static void visitOne(Self& self, int kind, F&& f) {
    int i = 0;
    self.visit([&](auto& c) {
      if (i++ == kind) f(c);
    });
  }

  const TreeSparsity* sparsity_ = nullptr;
  TreeSparsity coupled_;
  std::vector<Segment> couplings_, lastCouplings_;
  std::vector<int> couplingEnd_, lastCouplingEnd_;
};

static_assert(SoftConstraint<ConnectionRows>);
static_assert(SoftConstraint<WeldRows>);
static_assert(SoftConstraint<CouplingRows>);
static_assert(SoftConstraint<DryFriction>);
static_assert(SoftConstraint<JointLimit>);
static_assert(SoftConstraint<PyramidalContact>);
static_assert(SoftConstraint<EllipticContact>);

}  // namespace softgauss

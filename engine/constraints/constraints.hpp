// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Every soft constraint of the engine, and the operations that run over all of them:
///   s(Ja − r) of the extended Gauss principle (1.1), its force −Jᵀ∇s and curvature Jᵀ∇²s J.
///
/// To add an effect: write its file, add a member, name it in visitThese(). A kind that the plan
/// does not have is never called; one without rows in this step is called once, to find that out.

#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "softgauss/engine/constraints/connection.hpp"
#include "softgauss/engine/constraints/dry_friction.hpp"
#include "softgauss/engine/constraints/elliptic_contact.hpp"
#include "softgauss/engine/constraints/geometric_stiffness.hpp"
#include "softgauss/engine/constraints/joint_coupling.hpp"
#include "softgauss/engine/constraints/joint_limit.hpp"
#include "softgauss/engine/constraints/pyramidal_contact.hpp"
#include "softgauss/engine/constraints/servo_drive.hpp"
#include "softgauss/engine/constraints/weld.hpp"
#include "softgauss/engine/dynamics/tree_islands.hpp"
#include "softgauss/engine/model/plan.hpp"

namespace softgauss {

template <class C>
concept SoftConstraint = requires(C c, const Model& model, const Assembly& in, const VectorX& a,
                                  VectorX& tau, std::vector<double>& y, TreeMatrix& P,
                                  bool& changed, Jet& jet, std::vector<Crossing>& crossings) {
  { c.rowCount() } -> std::convertible_to<int>;
  { c.bytes() } -> std::convertible_to<std::size_t>;       // memory held
  c.assemble(in);                                          // rows, a_ref, D
  c.multiply(a, y);                                        // y = J a
  { c.evaluate(changed) } -> std::convertible_to<double>;  // cost; force, curvature
  c.along(0.0, jet);                                       // derivatives along a ray
  c.advance(0.0);                                          // x += α dx
  c.setForceRate();                                        // df ← −∇²s dx
  c.addTransposed(y, tau);                                 // tau += Jᵀ y
  c.addCurvature(P);                                       // P += Jᵀ ∇²s J
  c.addRow(0, 1.0, tau);                                   // tau += scale · (row of J)ᵀ
  { c.selection } -> std::convertible_to<RowSelection>;    // what all these walk
  { c.bodyOf(model, 0) } -> std::convertible_to<int>;      // a body that the row moves
  c.findCrossings(0, crossings);                           // breakpoints along a ray
  { c.aboveBreakpoint(0, 0) } -> std::convertible_to<double>;
  { c.curvatureJump(0, 0) } -> std::convertible_to<double>;
  c.placeAtBreakpoint(0, 0, true);
  c.holdOnRay(0);
};

class Constraints {
 public:
  ConnectionRows connection;
  WeldRows weld;
  CouplingRows coupling;
  DryFriction dryFriction;
  JointLimit jointLimit;
  ServoDrive servo;
  GeometricStiffness geometricStiffness;
  PyramidalContact contact;
  EllipticContact ellipticContact;

  Constraints() = default;
  /// Only these kinds are ever called.
  explicit Constraints(RowKinds planned) : planned_(planned) {}

  /// Calls f with every kind that has rows in this step.
  template <class F>
  void visit(F&& f) {
    visitThese(*this, active_, f);
  }
  template <class F>
  void visit(F&& f) const {
    visitThese(*this, active_, f);
  }
  template <class F>
  void visitAllButContacts(F&& f) {
    visitJoints(*this, active_, f);
  }
  template <class F>
  void visitAllButContacts(F&& f) const {
    visitJoints(*this, active_, f);
  }
  /// Calls f with every kind, rows or not.
  template <class F>
  void visitAll(F&& f) const {
    visitThese(*this, RowKinds::all(), f);
  }

  /// Calls f with the contacts, of pyramidal cones and then of elliptic ones.
  template <class F>
  void visitContacts(F&& f) const {
    f(contact);
    f(ellipticContact);
  }
  /// Calls f with the contacts among which the row is; does nothing where it is no contact's.
  template <class F>
  void visitContactsOf(RowId id, F&& f) const {
    visitOne(*this, id.kind, [&](const auto& c) {
      if constexpr (requires { c.breakpointInFrame(0, 0); }) f(c);
    });
  }

  void assemble(const Assembly& in);
  /// Whether rows were to be given their columns later (Columns).
  bool columnsComeLater() const { return columnsComeLater_; }
  /// Gives them to the rows that are selected; couple() once all that need some have them.
  void addColumns(const Model& model, const Kinematics& k, const TreeSparsity& tree);
  /// Makes room for what steps ask for besides rows, for as many as there is room for: the last
  /// motion, and columns that come later.
  void reserve(const Model& model);
  /// Sets the pattern of P, of the rows that have columns.
  void couple(const TreeSparsity& tree);
  /// forces ← those of the rows' present f, as State::connectionForces; of connections of these
  /// trees (1) alone, unless `trees` is empty.
  void connectionForces(const Model& model, const Kinematics& k,
                        std::span<const std::uint8_t> trees, VectorX& forces);
  int rowCount() const;
  /// Kinds that may make rows, and those that have some in this step.
  RowKinds planned() const { return planned_; }
  RowKinds active() const { return active_; }
  /// How often mechanisms have acted on the rows of this step.
  const MechanismCounts& acted() const { return acted_; }
  /// How often each kind was asked for its rows since the start.
  const std::array<std::int64_t, kRowKinds>& calls() const { return calls_; }
  /// Pattern of P = M + Jᵀ∇²s J: the trees', or with fill-in where rows couple branches.
  const TreeSparsity& sparsity() const { return *sparsity_; }

  /// x ← J a − a_ref, a of joints or of joints and bodies (BodyMotion).
  template <class Acceleration>
  void setResidual(const Acceleration& a) {
    visit([&](auto& c) {
      c.multiply(a, c.x);
      c.selection.forEach([&](std::size_t i) { c.x[i] -= c.reference[i]; });
    });
    if (active_.has(RowKind::ellipticCone)) ellipticContact.clearBreakpointPlacement();
  }
  /// dx ← J d.
  template <class Acceleration>
  void setRay(const Acceleration& d) {
    visit([&](auto& c) { c.multiply(d, c.dx); });
  }
  /// Forces and curvatures at x; returns the cost s(x) and whether any row changed its piece.
  double evaluate(bool& cellChanged);
  /// Adds the derivatives of s(x + α dx) in α.
  void along(double alpha, Jet& jet) const;
  /// Whether s is one quadratic on the ray up to α = 1: no row changes its piece, no cone bends.
  bool staysInCell() const;
  void advance(double alpha);
  /// tau ← tau + Jᵀf, tau of joints or of joints and bodies (BodyForce).
  template <class Forces>
  void addForce(Forces& tau) const {
    visit([&](const auto& c) { c.addTransposed(c.f, tau); });
  }
  /// df ← −∇²s dx: the rates of the rows' forces along the ray, at the present residual.
  void setForceRate();
  /// Adds the rate of that force along the ray, −Jᵀ∇²s dx.
  void addForceRate(VectorX& tau);
  /// P ← P + Jᵀ∇²s J.
  template <class Curvature>
  void addCurvature(Curvature& P) {
    visit([&](auto& c) { c.addCurvature(P); });
  }
  /// Appends the pairs of bodies that rows couple.
  void appendPairs(std::vector<std::pair<int, int>>& pairs) const;
  /// Appends the pairs of bodies whose joints rows couple.
  void appendCoupledBodies(const Model& model, std::vector<std::pair<int, int>>& pairs) const {
    if (active_.has(RowKind::coupling)) coupling.appendCoupledBodies(model, pairs);
  }
  /// Finds the rows of each island, which select() needs.
  void divide(const Model& model, const TreeIslands& islands);
  /// From here on everything that runs over the rows does over those of one island, until
  /// selectAll() or assemble(); −1: over all.
  void select(int island) {
    selected_ = island;
    visit([&](auto& c) { c.selection.select(island); });
  }
  void selectAll() { select(-1); }
  /// The island that is selected; −1: all.
  int selected() const { return selected_; }
  /// Rows that are selected.
  int selectedRows() const;
  /// Whether s is a sum of piecewise quadratics at present, so that findCrossings() is complete.
  bool piecewiseQuadratic() const { return ellipticContact.rowCount() == 0; }
  /// All breakpoints ahead on the ray, α ≥ 0, unordered.
  void findCrossings(std::vector<Crossing>& crossings) const;
  /// The first breakpoint ahead on the ray, counted from the pieces in which the rows are kept;
  /// alpha = ∞ if there is none. Only where s is piecewise quadratic.
  Crossing nextCrossing() const;
  /// Puts a row at a breakpoint, in the piece above it or the one below.
  void enterPiece(Breakpoint breakpoint, bool above);
  bool isAbove(Breakpoint breakpoint) const;
  /// Forces and curvatures at x with every row in the piece in which it is kept.
  void evaluateInPlace();
  /// y ← y + scale · (row of J)ᵀ.
  void addRow(RowId id, double scale, VectorX& y) const;
  /// How far the row is above its breakpoint: x less x there, or what takes its place on a cone.
  double aboveBreakpoint(Breakpoint breakpoint) const;
  /// y ← the gradient in a of that distance.
  void breakpointGradient(Breakpoint breakpoint, VectorX& y) const;
  /// s″ above a breakpoint less s″ below it.
  double curvatureJump(Breakpoint breakpoint) const;
  /// The name by which find() has the breakpoint again in a later step.
  BreakpointKey nameOf(Breakpoint breakpoint) const;
  /// The breakpoint of that name; nothing where its row does not exist now, or is not selected.
  std::optional<Breakpoint> find(const BreakpointKey& name) const;
  /// Puts the row exactly at its breakpoint, where it is free, or next to it on the stiff side.
  void placeAtBreakpoint(Breakpoint breakpoint, bool stiffSide);
  /// Takes a row off the ray.
  void holdOnRay(RowId id);
  /// (rows × nv) J, dense; allocates.
  MatrixX denseJacobian() const;

 private:
  /// Calls f, with a kind or with a kind and its number, for each of `kinds`.
  template <class Self, class F>
  static void visitThese(Self& self, RowKinds kinds, F&& f) {
    visitJoints(self, kinds, f);
    call(self.contact, RowKind::pyramid, kinds, f);
    call(self.ellipticContact, RowKind::ellipticCone, kinds, f);
  }
  /// The same for those that are no contacts.
  template <class Self, class F>
  static void visitJoints(Self& self, RowKinds kinds, F&& f) {
    call(self.connection, RowKind::connection, kinds, f);
    call(self.weld, RowKind::weld, kinds, f);
    call(self.coupling, RowKind::coupling, kinds, f);
    call(self.dryFriction, RowKind::dryFriction, kinds, f);
    call(self.jointLimit, RowKind::jointLimit, kinds, f);
    call(self.servo, RowKind::servo, kinds, f);
    call(self.geometricStiffness, RowKind::geometricStiffness, kinds, f);
  }
  template <class C, class F>
  static void call(C& c, RowKind kind, RowKinds kinds, F&& f) {
    if (!kBuiltRows.has(kind) || !kinds.has(kind)) return;
    if constexpr (std::invocable<F, C&, int>)
      f(c, static_cast<int>(kind));
    else
      f(c);
  }
  /// Calls f with the effect of a row.
  template <class Self, class F>
  static void visitOne(Self& self, int kind, F&& f) {
    visitThese(self, RowKinds::none().with(static_cast<RowKind>(kind)), f);
  }

  RowKinds planned_ = RowKinds::all();
  RowKinds active_ = RowKinds::none();
  std::array<std::int64_t, kRowKinds> calls_{};
  int selected_ = -1;
  bool columnsComeLater_ = false;
  SupportedMass load_;
  MechanismCounts acted_;
  const TreeSparsity* sparsity_ = nullptr;
  TreeSparsity coupled_;
  VectorX rowForces_;               ///< (nv) Jᵀf
  std::vector<Force> bodyForces_;   ///< (bodies) scratch of it
  std::vector<Motion> lastMotion_;  ///< (bodies) Assembly::lastMotion
  std::vector<Segment> couplings_, lastCouplings_;
  std::vector<int> couplingEnd_, lastCouplingEnd_;
};

static_assert(SoftConstraint<ConnectionRows>);
static_assert(SoftConstraint<WeldRows>);
static_assert(SoftConstraint<CouplingRows>);
static_assert(SoftConstraint<DryFriction>);
static_assert(SoftConstraint<JointLimit>);
static_assert(SoftConstraint<ServoDrive>);
static_assert(SoftConstraint<GeometricStiffness>);
static_assert(SoftConstraint<PyramidalContact>);
static_assert(SoftConstraint<EllipticContact>);

}  // namespace softgauss

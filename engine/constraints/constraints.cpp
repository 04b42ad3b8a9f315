// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/constraints.hpp"

#include <algorithm>

namespace softgauss {
namespace {

bool same(const std::vector<Segment>& a, const std::vector<Segment>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](Segment s, Segment t) { return s.begin == t.begin && s.end == t.end; });
}

/// Made of what connections do, after them.
bool isSwing(int kind) { return kind == static_cast<int>(RowKind::swing); }

bool isContact(int kind) {
  return kind == static_cast<int>(RowKind::pyramid) ||
         kind == static_cast<int>(RowKind::ellipticCone);
}

}  // namespace

void Constraints::assemble(const Assembly& given) {
  Assembly in = given;
  acted_ = {};
  in.acted = &acted_;
  if (in.model.options.uses(Mechanism::carriedLoad)) {
    load_.assemble(in.model, in.kinematics, in.contacts, in.weights);
    in.load = &load_;
  }
  active_ = RowKinds::none();
  visitThese(*this, planned_, [&](auto& c, int kind) {
    // Without contacts there is nothing to look at, but old rows to drop.
    const bool nothing = isSwing(kind) || (isContact(kind) && in.contacts.size() == 0);
    if (nothing && c.rowCount() == 0) return;
    ++calls_[kind];
    c.assemble(in);
    if (c.rowCount() > 0) active_.insert(kind);
  });
  if (active_.empty()) {
    sparsity_ = &in.tree;
    return;
  }
  couple(in.tree);
}

void Constraints::couple(const TreeSparsity& tree) {
  couplings_.clear();
  couplingEnd_.clear();
  visit([&](const auto& c) {
    if constexpr (requires { c.appendCouplings(couplings_, couplingEnd_); })
      c.appendCouplings(couplings_, couplingEnd_);
  });
  if (couplings_.empty()) {
    sparsity_ = &tree;
    return;
  }
  if (!same(couplings_, lastCouplings_) || couplingEnd_ != lastCouplingEnd_) {
    coupled_.couple(tree, couplings_, couplingEnd_);
    lastCouplings_ = couplings_;
    lastCouplingEnd_ = couplingEnd_;
  }
  sparsity_ = &coupled_;
}

int Constraints::holdSwings(const Assembly& in) {
  if (!planned_.has(RowKind::swing) || !active_.has(RowKind::connection)) return 0;
  rowForces_.setZero(in.model.nv);
  addForce(rowForces_);
  const int held = swing.hold(in, connection, rowForces_);
  if (held > 0) {
    active_.insert(RowKind::swing);
    couple(in.tree);
  }
  return held;
}

int Constraints::rowCount() const {
  int rows = 0;
  visit([&](const auto& c) { rows += c.rowCount(); });
  return rows;
}

void Constraints::setResidual(const VectorX& a) {
  visit([&](auto& c) {
    c.multiply(a, c.x);
    for (std::size_t i = 0; i < c.x.size(); ++i) c.x[i] -= c.reference[i];
  });
  if (active_.has(RowKind::ellipticCone)) ellipticContact.letGo();
}

void Constraints::setRay(const VectorX& d) {
  visit([&](auto& c) { c.multiply(d, c.dx); });
}

double Constraints::evaluate(bool& cellChanged) {
  double cost = 0.0;
  visit([&](auto& c) { cost += c.evaluate(cellChanged); });
  return cost;
}

void Constraints::along(double alpha, Jet& jet) const {
  visit([&](const auto& c) { c.along(alpha, jet); });
}

void Constraints::advance(double alpha) {
  visit([&](auto& c) { c.advance(alpha); });
}

void Constraints::addForce(VectorX& tau) const {
  visit([&](const auto& c) { c.addTransposed(c.f, tau); });
}

void Constraints::setForceRate() {
  visit([](auto& c) { c.setForceRate(); });
}

void Constraints::addForceRate(VectorX& tau) {
  visit([&](auto& c) {
    c.setForceRate();
    c.addTransposed(c.df, tau);
  });
}

void Constraints::addCurvature(TreeMatrix& P) {
  visit([&](auto& c) { c.addCurvature(P); });
}

void Constraints::findCrossings(std::vector<Crossing>& crossings) const {
  visit([&](const auto& c, int kind) { c.findCrossings(kind, crossings); });
}

Crossing Constraints::nextCrossing() const {
  Crossing next;
  next.alpha = kInfinity;
  visit([&](const auto& c, int kind) {
    if constexpr (requires { c.findNextCrossing(kind, next); }) c.findNextCrossing(kind, next);
  });
  return next;
}

void Constraints::enterPiece(Knot knot, bool above) {
  visitOne(*this, knot.row.kind, [&](auto& c) {
    if constexpr (requires { c.enterPiece(0, 0, above); })
      c.enterPiece(knot.row.row, knot.index, above);
  });
}

bool Constraints::isAbove(Knot knot) const {
  bool above = false;
  visitOne(*this, knot.row.kind, [&](const auto& c) {
    if constexpr (requires { c.isAbove(0, 0); }) above = c.isAbove(knot.row.row, knot.index);
  });
  return above;
}

void Constraints::evaluateInPlace() {
  visit([](auto& c) {
    if constexpr (requires { c.evaluateInPlace(); }) c.evaluateInPlace();
  });
}

void Constraints::addRow(RowId id, double scale, VectorX& y) const {
  visitOne(*this, id.kind, [&](const auto& c) { c.addRow(id.row, scale, y); });
}

double Constraints::aboveKnot(Knot knot) const {
  double x = 0.0;
  visitOne(*this, knot.row.kind, [&](const auto& c) { x = c.aboveKnot(knot.row.row, knot.index); });
  return x;
}

void Constraints::knotGradient(Knot knot, VectorX& y) const {
  y.setZero();
  visitOne(*this, knot.row.kind, [&](const auto& c) {
    if constexpr (requires { c.addKnotGradient(0, 0, 1.0, y); })
      c.addKnotGradient(knot.row.row, knot.index, 1.0, y);
    else
      c.addRow(knot.row.row, 1.0, y);
  });
}

double Constraints::curvatureJump(Knot knot) const {
  double jump = 0.0;
  visitOne(*this, knot.row.kind,
           [&](const auto& c) { jump = c.curvatureJump(knot.row.row, knot.index); });
  return jump;
}

KnotName Constraints::nameOf(Knot knot) const {
  KnotName name{.kind = knot.row.kind, .row = {}, .index = knot.index};
  visitOne(*this, knot.row.kind, [&](const auto& c) {
    if constexpr (requires { c.name(0); }) name.row = c.name(knot.row.row);
  });
  return name;
}

std::optional<Knot> Constraints::find(const KnotName& name) const {
  std::optional<Knot> found;
  visitOne(*this, name.kind, [&](const auto& c) {
    if constexpr (requires { c.name(0); })
      for (int row = 0; row < c.rowCount() && !found; ++row)
        if (c.name(row) == name.row) found = Knot{{name.kind, row}, name.index};
  });
  return found;
}

void Constraints::placeAtKnot(Knot knot, bool stiffSide) {
  visitOne(*this, knot.row.kind,
           [&](auto& c) { c.placeAtKnot(knot.row.row, knot.index, stiffSide); });
}

void Constraints::holdOnRay(RowId id) {
  visitOne(*this, id.kind, [&](auto& c) { c.holdOnRay(id.row); });
}

MatrixX Constraints::denseJacobian() const {
  MatrixX J(rowCount(), sparsity_->size());
  VectorX row(J.cols());
  int first = 0;
  visit([&](const auto& c) {
    for (int i = 0; i < c.rowCount(); ++i) {
      row.setZero();
      c.addRow(i, 1.0, row);
      J.row(first + i) = row.transpose();
    }
    first += c.rowCount();
  });
  return J;
}

}  // namespace softgauss

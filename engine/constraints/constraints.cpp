// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/constraints.hpp"

#include <algorithm>
#include <utility>

namespace softgauss {
namespace {

bool same(const std::vector<Segment>& a, const std::vector<Segment>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](Segment s, Segment t) { return s.begin == t.begin && s.end == t.end; });
}

bool isContact(int kind) {
  return kind == static_cast<int>(RowKind::pyramid) ||
         kind == static_cast<int>(RowKind::ellipticCone);
}

}  // namespace

void Constraints::assemble(const Assembly& given) {
  Assembly in = given;
  acted_ = {};
  selected_ = -1;
  columnsComeLater_ = in.columns == Columns::later;
  in.acted = &acted_;
  if (in.model.options.uses(Mechanism::supportedMass)) {
    load_.assemble(in.model, in.kinematics, in.contacts, in.weights);
    in.load = &load_;
  }
  if (in.columns != Columns::now && in.state.hasAcceleration && in.contacts.size() > 0) {
    lastMotion_.resize(in.model.bodies.size());
    const Segment all = allBodies(in.model);
    moveBodies(in.model, in.kinematics, in.trees ? in.trees->bodies() : Segments(&all, 1),
               in.state.a, lastMotion_);
    in.lastMotion = &lastMotion_;
  }
  active_ = RowKinds::none();
  visitThese(*this, planned_, [&](auto& c, int kind) {
    // Without contacts there is nothing to look at, but old rows to drop.
    if (isContact(kind) && in.contacts.size() == 0 && c.rowCount() == 0) return;
    ++calls_[kind];
    c.assemble(in);
    if (c.rowCount() > 0) active_.insert(kind);
  });
  if (active_.empty() || in.columns != Columns::now) {
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

void Constraints::addColumns(const Model& model, const Kinematics& k, const TreeSparsity& tree) {
  visit([&](auto& c) {
    if constexpr (requires { c.addColumns(model, k, tree); }) c.addColumns(model, k, tree);
  });
}

void Constraints::reserve(const Model& model) {
  lastMotion_.reserve(model.bodies.size());
  if (model.trees.size() == 1) return;
  visitThese(*this, planned_, [](auto& c) {
    if constexpr (requires { c.reserveColumns(); }) c.reserveColumns();
  });
}

void Constraints::connectionForces(const Model& model, const Kinematics& k,
                                   std::span<const std::uint8_t> trees, VectorX& forces) {
  const auto numbers = 9 * static_cast<Eigen::Index>(model.connections.size());
  if (forces.size() != numbers) forces.setZero(numbers);
  const auto treeOf = [&](int body) { return model.bodies[static_cast<std::size_t>(body)].tree; };
  const auto meant = [&](int body) {
    const int tree = treeOf(body);
    return trees.empty() || (tree >= 0 && trees[static_cast<std::size_t>(tree)] != 0);
  };
  if (!active_.has(RowKind::connection)) {
    for (std::size_t i = 0; i < model.connections.size(); ++i)
      if (meant(model.connections[i].bodyA) || meant(model.connections[i].bodyB))
        forces.segment<9>(9 * static_cast<Eigen::Index>(i)).setZero();
    return;
  }
  rowForces_.setZero(model.nv);
  bodyForces_.assign(model.bodies.size(), Force{});
  BodyForce force{rowForces_, bodyForces_};
  addForce(force);
  addBodyForces(model, k, bodyForces_, rowForces_);
  const auto onTree = [&](int body) -> Vector3 {
    const int tree = treeOf(body);
    if (tree < 0 || !model.floats(tree)) return Vector3::Zero();
    return rowForces_.segment<3>(model.trees[static_cast<std::size_t>(tree)].firstDof);
  };
  const double* f = connection.f.data();
  for (const int i : connection.connections()) {
    const Connection& c = model.connections[idx(i)];
    const Eigen::Map<const Vector3> f_W(std::exchange(f, f + 3));
    if (!meant(c.bodyA) && !meant(c.bodyB)) continue;
    forces.segment<9>(9 * static_cast<Eigen::Index>(i)) << f_W, onTree(c.bodyA), onTree(c.bodyB);
  }
}

int Constraints::rowCount() const {
  int rows = 0;
  visit([&](const auto& c) { rows += c.rowCount(); });
  return rows;
}

void Constraints::divide(const Model& model, const TreeIslands& islands) {
  visit([&](auto& c) {
    c.selection.divide(islands.size(), model.trees.size(),
                       [&](int row) { return islands.ofBody()[idx(c.bodyOf(model, row))]; });
  });
}

int Constraints::selectedRows() const {
  int rows = 0;
  visit([&](const auto& c) { rows += c.selection.count(); });
  return rows;
}

double Constraints::evaluate(bool& cellChanged) {
  double cost = 0.0;
  visit([&](auto& c) { cost += c.evaluate(cellChanged); });
  return cost;
}

void Constraints::along(double alpha, Jet& jet) const {
  visit([&](const auto& c) { c.along(alpha, jet); });
}

bool Constraints::staysInCell() const {
  bool stays = true;
  visit([&](const auto& c) { stays = stays && c.staysInCell(); });
  return stays;
}

void Constraints::advance(double alpha) {
  visit([&](auto& c) { c.advance(alpha); });
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

void Constraints::appendPairs(std::vector<std::pair<int, int>>& pairs) const {
  visit([&](const auto& c) {
    if constexpr (requires { c.appendPairs(pairs); }) c.appendPairs(pairs);
  });
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

void Constraints::enterPiece(Breakpoint breakpoint, bool above) {
  visitOne(*this, breakpoint.row.kind, [&](auto& c) {
    if constexpr (requires { c.enterPiece(0, 0, above); })
      c.enterPiece(breakpoint.row.row, breakpoint.index, above);
  });
}

bool Constraints::isAbove(Breakpoint breakpoint) const {
  bool above = false;
  visitOne(*this, breakpoint.row.kind, [&](const auto& c) {
    if constexpr (requires { c.isAbove(0, 0); })
      above = c.isAbove(breakpoint.row.row, breakpoint.index);
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

double Constraints::aboveBreakpoint(Breakpoint breakpoint) const {
  double x = 0.0;
  visitOne(*this, breakpoint.row.kind,
           [&](const auto& c) { x = c.aboveBreakpoint(breakpoint.row.row, breakpoint.index); });
  return x;
}

void Constraints::breakpointGradient(Breakpoint breakpoint, VectorX& y) const {
  y.setZero();
  visitOne(*this, breakpoint.row.kind, [&](const auto& c) {
    if constexpr (requires { c.addBreakpointGradient(0, 0, 1.0, y); })
      c.addBreakpointGradient(breakpoint.row.row, breakpoint.index, 1.0, y);
    else
      c.addRow(breakpoint.row.row, 1.0, y);
  });
}

double Constraints::curvatureJump(Breakpoint breakpoint) const {
  double jump = 0.0;
  visitOne(*this, breakpoint.row.kind,
           [&](const auto& c) { jump = c.curvatureJump(breakpoint.row.row, breakpoint.index); });
  return jump;
}

BreakpointKey Constraints::nameOf(Breakpoint breakpoint) const {
  BreakpointKey name{.kind = breakpoint.row.kind, .row = {}, .index = breakpoint.index};
  visitOne(*this, breakpoint.row.kind, [&](const auto& c) {
    if constexpr (requires { c.name(0); }) name.row = c.name(breakpoint.row.row);
  });
  return name;
}

std::optional<Breakpoint> Constraints::find(const BreakpointKey& name) const {
  std::optional<Breakpoint> found;
  visitOne(*this, name.kind, [&](const auto& c) {
    if constexpr (requires { c.name(0); })
      for (int row = 0; row < c.rowCount() && !found; ++row)
        if (c.name(row) == name.row && c.selection.has(row))
          found = Breakpoint{{name.kind, row}, name.index};
  });
  return found;
}

void Constraints::placeAtBreakpoint(Breakpoint breakpoint, bool stiffSide) {
  visitOne(*this, breakpoint.row.kind,
           [&](auto& c) { c.placeAtBreakpoint(breakpoint.row.row, breakpoint.index, stiffSide); });
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

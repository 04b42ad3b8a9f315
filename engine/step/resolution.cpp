// SPDX-License-Identifier: Apache-2.0
#include "engine/step/resolution.hpp"

#include <algorithm>
#include <cmath>

#include "engine/constraints/contact_turn.hpp"
#include "engine/core/memory.hpp"
#include "engine/step/forward.hpp"
#include "engine/step/integrators/tree_turn.hpp"

namespace softgauss {

const double Resolution::kFollowedTurn = 1e-4;

namespace {

double contactRate(const Model& model, const Data& data) {
  double rate = 0.0;
  for (const Contact& c : data.contacts.contacts)
    rate = std::max(rate, turnRate(model, data.kinematics, c));
  return rate;
}

double tieRate(const Model& model, const Data& data) {
  double fastest = 0.0;
  const auto add = [&](int body) {
    fastest = std::max(fastest, data.kinematics.turning()[body].angular.norm());
  };
  for (const Connection& c : model.connections) add(c.bodyA), add(c.bodyB);
  for (const Weld& w : model.welds) add(w.bodyA), add(w.bodyB);
  return 4.0 * fastest;
}

}  // namespace

Resolution::Resolution(const Model& model)
    : turn(model.trees.size(), 0.0),
      free(model.trees.size(), 0),
      tied_(model.trees.size(), 0),
      touched_(model.trees.size(), 0),
      change_(VectorX::Zero(model.nv)),
      velocity_(VectorX::Zero(model.nv)),
      Mchange_(change_),
      Mv_(change_),
      Ma_(change_) {
  const auto tie = [&](int body) {
    if (model.bodies[body].tree >= 0) tied_[model.bodies[body].tree] = 1;
  };
  for (const Connection& c : model.connections) tie(c.bodyA), tie(c.bodyB);
  for (const Weld& w : model.welds) tie(w.bodyA), tie(w.bodyB);
}

std::size_t Resolution::bytes() const {
  return bytesOfAll(turn, free, tied_, touched_, change_, velocity_, Mchange_, Mv_, Ma_);
}

void Resolution::findTouched(const Model& model, const Data& data) {
  touched_ = tied_;
  for (const Contact& c : data.contacts.contacts)
    for (const int body : {c.bodyA, c.bodyB})
      if (model.bodies[body].tree >= 0) touched_[model.bodies[body].tree] = 1;
  velocity_.setZero();
  data.constraints.visitAllButContacts([&](const auto& c) {
    // Weights that differ, lest two rows of a joint cancel.
    for (int i = 0; i < c.rowCount(); ++i) c.addRow(i, 1.0 + i, velocity_);
  });
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const Tree& tree = model.trees[t];
    const auto rows = velocity_.segment(tree.firstDof, tree.dofEnd - tree.firstDof);
    if ((rows.array() != 0.0).any()) touched_[t] = 1;
  }
}

/// turn of every tree: Δb = b(q, v′) − b(q, v), of v and the velocity of turning v′.
void Resolution::findTurns(const Model& model, const State& state, Data& data) {
  const double h = model.options.timestep;
  computeBiasAt(model, data.kinematics, data.inertia, state.v, data.forces.work, change_);
  ++data.forces.calls.coriolis;
  change_ = data.forces.bias - change_;
  if (!solveMass(data, nullptr, change_)) return;  // the solve will say so
  const VectorX& a = state.a;
  bool multiplied = false;
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    const Tree& tree = model.trees[t];
    const int first = tree.firstDof, dofs = tree.dofEnd - first;
    turn[t] = h * turnRate(model, tree, data, state.v, a, change_);
    if (!isPassive(tree, tied_[t], data, state.v, a, h)) continue;
    if (!multiplied) {
      data.inertia.M.multiply(change_, Mchange_);
      data.inertia.M.multiply(state.v, Mv_);
      data.inertia.M.multiply(a, Ma_);
      multiplied = true;
    }
    const auto dot = [&](const VectorX& x, const VectorX& y) {
      return x.segment(first, dofs).dot(y.segment(first, dofs));
    };
    const double moving = dot(state.v, Mv_) + h * h * dot(a, Ma_);
    turn[t] = std::max(turn[t], h * energyRate(dot(change_, Mchange_), moving));
  }
}

/// A control acts on the tree, or applied forces that change its motion by more than a thousandth.
bool Resolution::driven(const Model& model, const Data& data, const State& state, int t,
                        bool controlled) const {
  const Tree& tree = model.trees[t];
  if (controlled)
    for (int i = tree.firstDof; i < tree.dofEnd; ++i)
      if (model.dofs[i].actuated) return true;
  return drives(tree, data, state.v, state.a, model.options.timestep);
}

void Resolution::find(const Model& model, const State& state, bool controlled, Data& data) {
  parts = 1;
  anyFree = false;
  std::fill(free.begin(), free.end(), 0);
  std::fill(turn.begin(), turn.end(), 0.0);
  if (!data.plan.coriolis || model.options.partAngle == kInfinity ||
      !mayTurnFar(model, data, state.v, state.a))
    return;
  const double h = model.options.timestep;
  const MechanismSet& mechanisms = model.options.mechanisms;
  if (state.aIsKnown) findTurns(model, state, data);
  double rate = std::max(contactRate(model, data), tieRate(model, data));
  bool touchedKnown = false;
  for (std::size_t t = 0; t < model.trees.size(); ++t) {
    if (!(turn[t] > kFollowedTurn)) continue;
    if (!touchedKnown) findTouched(model, data), touchedKnown = true;
    const int tree = static_cast<int>(t);
    const double ofTree = 4.0 * std::sqrt(2.0 * turn[t]) / h;
    const bool mayFollow = mechanisms.has(Mechanism::freeTrees) && !touched_[t] &&
                           !dampingStops(model.trees[t], data, h);
    const bool tooMany = !(h * ofTree <= kMostParts * model.options.partAngle);
    if (mayFollow && (tooMany || !driven(model, data, state, tree, controlled)))
      free[t] = 1, anyFree = true;
    else
      rate = std::max(rate, ofTree);
  }
  if (!mechanisms.has(Mechanism::parts)) return;
  const double needed = std::ceil(h * rate / model.options.partAngle - 1e-9);
  parts = needed < kMostParts ? std::max(1, static_cast<int>(needed)) : kMostParts;
}

}  // namespace softgauss

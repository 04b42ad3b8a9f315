// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/island_substeps.hpp"

#include <algorithm>

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {
namespace {

/// The coordinates q of these bodies.
Segment coordinatesOf(const Model& model, Segment bodies) {
  const Body &first = model.bodies[idx(bodies.begin)], &last = model.bodies[idx(bodies.end - 1)];
  return {first.q, last.q + (last.joint == JointKind::floating ? 7 : 1)};
}

}  // namespace

IslandSubsteps::IslandSubsteps(const Model& model)
    : data(model, Data::Evaluation{}), state(model), islands_(model) {
  data.parts = std::make_unique<SubstepWorkspace>(model);
  parts_.reserve(model.trees.size());
}

void IslandSubsteps::reserve(std::size_t contacts) {
  contacts_.reserve(contacts);
  pairs_.reserve(2 * contacts + data.bodies.pairs.size());
}

void IslandSubsteps::findPairs(const Model& model, bool controlled, const Data& whole) {
  pairs_.clear();
  for (const Contact& c : whole.contacts.contacts)
    if (c.bodyA != 0 && c.bodyB != 0) pairs_.emplace_back(c.bodyA, c.bodyB);
  whole.constraints.appendPairs(pairs_);
  whole.constraints.appendCoupledBodies(model, pairs_);
  int first = 0;
  for (const Tree& tree : model.trees)
    if (controlled && tree.actuated) {
      if (first != 0) pairs_.emplace_back(first, tree.rootBody);
      first = tree.rootBody;
    }
}

bool IslandSubsteps::divide(const Model& model, bool controlled, const Data& whole) {
  any_ = false;
  findPairs(model, controlled, whole);
  islands_.find(model, pairs_);
  if (islands_.size() == 1) return false;
  parts_.assign(idx(islands_.size()), 1);
  const std::vector<int>& needed = whole.parts->substepSelection.partsOf;
  const auto partsOf = [&](const Tree& tree) -> int& {
    return parts_[idx(islands_.ofBody()[idx(tree.rootBody)])];
  };
  for (std::size_t t = 0; t < model.trees.size(); ++t)
    partsOf(model.trees[t]) = std::max(partsOf(model.trees[t]), needed[t]);
  for (const Tree& tree : model.trees)
    if (controlled && tree.actuated && partsOf(tree) > 1) return false;
  contacts_.clear();
  return any_ = true;
}

void IslandSubsteps::begin(const Model& model, int island, const State& before, const VectorX& a,
                           const VectorX& connectionForces) {
  data.active.select(model, [&](int tree) {
    return islands_.ofBody()[idx(model.trees[idx(tree)].rootBody)] == island;
  });
  data.forces.bias.setZero();  // of trees that the last island had
  data.parts->before = before;
  data.parts->predicted = a;
  data.parts->predictedForces = connectionForces;
  data.parts->substepSelection.parts = parts(island);
}

void IslandSubsteps::finish(const Model& model, int island, Data& whole, State& to) {
  for (const Segment bodies : islands_.bodies(island)) {
    const Segment coordinates = coordinatesOf(model, bodies);
    part(to.q, coordinates) = part(state.q, coordinates);
  }
  const Segments dofs = islands_.dofs(island);
  copy(dofs, state.v, to.v);
  copy(dofs, state.a, to.a);
  copy(dofs, state.warmstart.a, to.warmstart.a);
  copy(dofs, data.forward.a, whole.forward.a);
  copy(dofs, data.acceleration, whole.acceleration);
  for (std::size_t i = 0; i < model.connections.size(); ++i) {
    const Connection& c = model.connections[i];
    const Segment at{9 * static_cast<int>(i), 9 * static_cast<int>(i) + 9};
    if (data.active.holds(model, c.bodyA, c.bodyB))
      part(to.connectionForces, at) = part(state.connectionForces, at);
  }
  const ServoDrive& servo = data.constraints.servo;
  ServoDrive& all = whole.constraints.servo;
  for (int row = 0, of = 0; row < servo.rowCount(); ++row) {  // both by dof
    while (of < all.rowCount() && all.dof(of) != servo.dof(row)) ++of;
    if (of < all.rowCount()) all.f[idx(of)] = servo.f[idx(row)];
  }
  appendContactForces(data, contacts_);
}

}  // namespace softgauss

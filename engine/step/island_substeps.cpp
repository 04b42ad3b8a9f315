// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/island_substeps.hpp"

#include <algorithm>

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {

IslandSubsteps::IslandSubsteps(const Model& model)
    : data(model, Data::Evaluation{}), state(model), islands_(model) {
  data.parts = std::make_unique<SubstepWorkspace>(model);
  parts_.reserve(model.trees.size());
}

void IslandSubsteps::reserve(std::size_t contacts) {
  contacts_.reserve(contacts);
  pairs_.reserve(2 * contacts + data.bodies.pairs.size());
}

void appendTouching(const Model& model, const Data& data, std::vector<std::pair<int, int>>& pairs) {
  for (const Contact& c : data.contacts.contacts)
    if (c.bodyA != 0 && c.bodyB != 0) pairs.emplace_back(c.bodyA, c.bodyB);
  data.constraints.appendPairs(pairs);
  data.constraints.appendCoupledBodies(model, pairs);
}

void IslandSubsteps::findPairs(const Model& model, bool controlled, const Data& whole) {
  pairs_.clear();
  appendTouching(model, whole, pairs_);
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
  islands_.find(model, pairs_, whole.active.still());
  if (islands_.size() == 1) return false;
  parts_.assign(idx(islands_.size()), 1);
  const std::vector<int>& needed = whole.parts->substepSelection.partsOf;
  const auto partsOf = [&](const Tree& tree) -> int& {
    return parts_[idx(islands_.ofBody()[idx(tree.rootBody)])];
  };
  for (const int t : whole.active.trees()) {
    int& parts = partsOf(model.trees[idx(t)]);
    parts = std::max(parts, needed[idx(t)]);
  }
  for (const int t : whole.active.trees())
    if (controlled && model.trees[idx(t)].actuated && partsOf(model.trees[idx(t)]) > 1)
      return false;
  contacts_.clear();
  return any_ = true;
}

void IslandSubsteps::begin(const Model& model, int island, const Data& whole, const State& before,
                           const VectorX& a, const VectorX& connectionForces) {
  data.timed = whole.timed;
  data.active.setStill(whole.active.still());
  data.active.select(model, [&](int tree) {
    return islands_.ofBody()[idx(model.trees[idx(tree)].rootBody)] == island;
  });
  data.parts->before = before;
  data.parts->predicted = a;
  data.parts->predictedForces = connectionForces;
  data.parts->substepSelection.parts = parts(island);
}

void IslandSubsteps::finish(const Model& model, int island, Data& whole, State& to) {
  copy(data.active.coordinates(), state.q, to.q);
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

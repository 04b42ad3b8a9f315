// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/tree_selection.hpp"

#include "softgauss/engine/core/segment_vectors.hpp"

namespace softgauss {
namespace {

void add(Segment s, std::vector<Segment>& segments) {
  if (!segments.empty() && segments.back().end == s.begin)
    segments.back().end = s.end;
  else
    segments.push_back(s);
}

}  // namespace

Segment coordinatesOf(const Model& model, const Tree& tree) {
  const Body &first = model.bodies[idx(tree.rootBody)], &last = model.bodies[idx(tree.bodyEnd - 1)];
  return {first.q, last.q + (last.joint == JointKind::floating ? 7 : 1)};
}

TreeSelection::TreeSelection(const Model& model) : flags_(model.trees.size()) {
  trees_.reserve(flags_.size());
  for (auto* segments : {&bodies_, &dofs_, &coordinates_}) segments->reserve(flags_.size());
  selectAll(model);
}

void TreeSelection::clear() {
  trees_.clear();
  for (auto* segments : {&bodies_, &dofs_, &coordinates_}) segments->clear();
}

void TreeSelection::append(const Model& model, int t) {
  const Tree& tree = model.trees[idx(t)];
  trees_.push_back(t);
  add({tree.rootBody, tree.bodyEnd}, bodies_);
  add({tree.firstDof, tree.dofEnd}, dofs_);
  add(coordinatesOf(model, tree), coordinates_);
}

void copyState(const TreeSelection& trees, const State& from, State& to) {
  const bool alike = from.v.size() == to.v.size() &&
                     from.warmstart.gddA.size() == to.warmstart.gddA.size() &&
                     from.warmstart.gddSearchAge.size() == to.warmstart.gddSearchAge.size();
  if (trees.all() || !alike) {
    to = from;
    return;
  }
  copy(trees.coordinates(), from.q, to.q);
  to.time = from.time;
  to.hasAcceleration = from.hasAcceleration;
  to.connectionForces = from.connectionForces;
  const WarmStart& warm = from.warmstart;
  for (const auto& [x, y] : {std::pair(&from.v, &to.v),
                             {&from.a, &to.a},
                             {&warm.a, &to.warmstart.a},
                             {&warm.gddA, &to.warmstart.gddA},
                             {&warm.multipliers, &to.warmstart.multipliers},
                             {&warm.control, &to.warmstart.control}})
    if (x->size() == y->size())
      copy(trees.dofs(), *x, *y);
    else
      *y = *x;
  to.warmstart.breakpoints = warm.breakpoints;
  to.warmstart.valid = warm.valid;
  to.warmstart.gddValid = warm.gddValid;
  for (const int t : trees.trees()) {
    to.warmstart.gddSearchAge[idx(t)] = warm.gddSearchAge[idx(t)];
    to.warmstart.gddSearchWait[idx(t)] = warm.gddSearchWait[idx(t)];
  }
}

}  // namespace softgauss

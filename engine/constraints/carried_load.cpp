// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/carried_load.hpp"

#include <algorithm>
#include <numeric>

namespace softgauss {

int CarriedLoad::root(int tree) {
  while (parent_[tree] != tree) tree = parent_[tree] = parent_[parent_[tree]];
  return tree;
}

void CarriedLoad::assemble(const Model& model, const ContactSet& contacts,
                           const InverseWeights& weights) {
  const auto treeOf = [&](int body) { return model.bodies[body].tree; };
  any_ = std::any_of(contacts.contacts.begin(), contacts.contacts.end(), [&](const Contact& c) {
    const int a = treeOf(c.bodyA), b = treeOf(c.bodyB);
    return a >= 0 && b >= 0 && a != b;
  });
  if (!any_) return;
  parent_.resize(model.trees.size());
  std::iota(parent_.begin(), parent_.end(), 0);
  mass_.assign(model.trees.size(), 0.0);
  for (const Contact& c : contacts.contacts) {
    for (const int body : {c.bodyA, c.bodyB}) {
      const int tree = treeOf(body);
      if (tree < 0) continue;
      const Body& base = model.bodies[model.trees[tree].rootBody];
      if (base.joint != JointKind::floating) continue;  // the world carries it
      const double most = model.trees[tree].mass, w = weights.translation[body];
      mass_[tree] = std::max(mass_[tree], w * most > 1.0 ? 1.0 / w : most);
    }
    const int a = treeOf(c.bodyA), b = treeOf(c.bodyB);
    if (a >= 0 && b >= 0) parent_[root(a)] = root(b);
  }
  island_.assign(model.trees.size(), 0.0);
  const int trees = static_cast<int>(model.trees.size());
  for (int t = 0; t < trees; ++t)
    if (root(t) != t) island_[root(t)] += mass_[t];
  for (int t = 0; t < trees; ++t)
    if (root(t) == t) island_[t] += mass_[t];
  for (int t = 0; t < trees; ++t) island_[t] = island_[root(t)];
}

double CarriedLoad::of(const Model& model, const Contact& c) const {
  if (!any_) return 0.0;
  const int a = model.bodies[c.bodyA].tree, b = model.bodies[c.bodyB].tree;
  const int some = a >= 0 ? a : b;
  if (some < 0) return 0.0;
  const double lighter = a >= 0 && b >= 0 ? std::min(mass_[a], mass_[b]) : mass_[some];
  return std::max(0.0, island_[some] - lighter);
}

}  // namespace softgauss

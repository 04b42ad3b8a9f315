// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/carried_load.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace softgauss {
namespace {

/// A tree on a fixed base, or none: the world carries it.
bool standsStill(const Model& model, int tree) {
  return tree < 0 || model.bodies[model.trees[tree].rootBody].joint != JointKind::floating;
}

}  // namespace

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
  weigh(model, contacts, weights);
  findLayers();
  passDown();
}

/// m of all trees, the islands' largest, and who touches whom.
void CarriedLoad::weigh(const Model& model, const ContactSet& contacts,
                        const InverseWeights& weights) {
  const std::size_t trees = model.trees.size();
  parent_.resize(trees);
  std::iota(parent_.begin(), parent_.end(), 0);
  mass_.assign(trees, 0.0);
  layer_.assign(trees, 0);
  head_.assign(trees, -1);
  links_.clear();
  order_.clear();
  for (const Contact& c : contacts.contacts) {
    const int a = model.bodies[c.bodyA].tree, b = model.bodies[c.bodyB].tree;
    if (a == b) continue;
    for (const auto& [body, tree, other] : {std::tuple(c.bodyA, a, b), std::tuple(c.bodyB, b, a)}) {
      if (standsStill(model, tree)) continue;
      const double most = model.trees[tree].mass, w = weights.translation[body];
      mass_[tree] = std::max(mass_[tree], w * most > 1.0 ? 1.0 / w : most);
      if (standsStill(model, other)) {
        if (layer_[tree] == 0) order_.push_back(tree);
        layer_[tree] = 1;
        continue;
      }
      links_.push_back({other, head_[tree]});
      head_[tree] = static_cast<int>(links_.size()) - 1;
    }
    if (a >= 0 && b >= 0) parent_[root(a)] = root(b);
  }
  island_.resize(trees);
  largest_.assign(trees, {});
  for (int t = 0; t < static_cast<int>(trees); ++t) {
    island_[t] = root(t);
    Largest& largest = largest_[island_[t]];
    largest.second = std::max(largest.second, std::min(largest.first, mass_[t]));
    largest.first = std::max(largest.first, mass_[t]);
  }
}

/// Breadth first from the trees that touch the world.
void CarriedLoad::findLayers() {
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const int tree = order_[i];
    for (int l = head_[tree]; l >= 0; l = links_[l].next) {
      const int other = links_[l].other;
      if (layer_[other] > 0) continue;
      layer_[other] = layer_[tree] + 1;
      order_.push_back(other);
    }
  }
}

/// From the farthest layer towards the world.
void CarriedLoad::passDown() {
  passed_ = mass_;
  for (std::size_t i = order_.size(); i-- > 0;) {
    const int tree = order_[i];
    const auto below = [&](const Link& link) { return layer_[link.other] == layer_[tree] - 1; };
    int shares = 0;
    for (int l = head_[tree]; l >= 0; l = links_[l].next) shares += below(links_[l]);
    for (int l = head_[tree]; l >= 0; l = links_[l].next)
      if (below(links_[l])) passed_[links_[l].other] += passed_[tree] / shares;
  }
}

double CarriedLoad::of(const Model& model, const Contact& c) const {
  if (!any_) return 0.0;
  const int a = model.bodies[c.bodyA].tree, b = model.bodies[c.bodyB].tree;
  const int some = a >= 0 ? a : b;
  if (some < 0) return 0.0;
  const Largest& largest = largest_[island_[some]];
  if (a >= 0 && b >= 0 && a != b) {
    double passed = std::max(passed_[a], passed_[b]);
    if (layer_[a] != layer_[b]) passed = passed_[layer_[a] > layer_[b] ? a : b];
    return std::max(largest.first, passed);
  }
  const double own = mass_[some];
  return std::max(own == largest.first ? largest.second : largest.first, passed_[some] - own);
}

}  // namespace softgauss

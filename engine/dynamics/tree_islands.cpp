// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/tree_islands.hpp"

#include <algorithm>

namespace softgauss {

TreeIslands::TreeIslands(const Model& model)
    : ofBody_(model.bodies.size()), next_(model.trees.size()) {
  const int trees = static_cast<int>(model.trees.size());
  first_.reserve(model.trees.size());
  last_.reserve(model.trees.size());
  bodies_.reserve(trees, trees);
  dofs_.reserve(trees, trees);
  find(model, {});
}

void TreeIslands::find(const Model& model, const std::vector<std::pair<int, int>>& pairs) {
  const int trees = static_cast<int>(model.trees.size());
  sets_.reset(trees);
  for (const auto& [bodyA, bodyB] : pairs) {
    const int a = model.bodies[idx(bodyA)].tree, b = model.bodies[idx(bodyB)].tree;
    if (a >= 0 && b >= 0) sets_.unite(a, b);
  }
  first_.clear();
  last_.clear();
  for (int tree = 0; tree < trees; ++tree) {
    next_[idx(tree)] = -1;
    const Tree& t = model.trees[idx(tree)];
    int island = static_cast<int>(first_.size());
    if (const int first = sets_.find(tree); first != tree) {
      island = ofBody_[idx(model.trees[idx(first)].rootBody)];
      next_[idx(last_[idx(island)])] = tree;
      last_[idx(island)] = tree;
    } else {
      first_.push_back(tree);
      last_.push_back(tree);
    }
    std::fill(ofBody_.begin() + t.rootBody, ofBody_.begin() + t.bodyEnd, island);
  }
  list(model);
}

void TreeIslands::list(const Model& model) {
  bodies_.clear();
  dofs_.clear();
  for (const int first : first_) {
    for (int t = first; t >= 0; t = next_[idx(t)]) {
      const Tree& tree = model.trees[idx(t)];
      bodies_.add({tree.rootBody, tree.bodyEnd});
      dofs_.add({tree.firstDof, tree.dofEnd});
    }
    bodies_.close();
    dofs_.close();
  }
}

}  // namespace softgauss

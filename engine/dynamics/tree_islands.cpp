// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/tree_islands.hpp"

#include <algorithm>

#include "softgauss/engine/dynamics/body_motion.hpp"

namespace softgauss {

TreeIslands::TreeIslands(const Model& model) : ofBody_(model.bodies.size()) {
  for (SegmentSets* sets : {&bodies_, &dofs_})
    sets->reserve(model.trees.size(), model.trees.size());
  find(model, {});
}

void TreeIslands::find(const Model& model, const std::vector<std::pair<int, int>>& pairs,
                       std::span<const std::uint8_t> still) {
  const int trees = static_cast<int>(model.trees.size());
  const auto isLeftOut = [&](int tree) { return !still.empty() && still[idx(tree)] != 0; };
  sets_.reset(trees);
  for (const auto& [bodyA, bodyB] : pairs) {
    const int a = model.bodies[idx(bodyA)].tree, b = model.bodies[idx(bodyB)].tree;
    if (a >= 0 && b >= 0 && !isLeftOut(a) && !isLeftOut(b)) sets_.unite(a, b);
  }
  int islands = 0;
  for (int t = 0; t < trees; ++t) {
    const Tree& tree = model.trees[idx(t)];
    if (isLeftOut(t)) {
      std::fill(ofBody_.begin() + tree.rootBody, ofBody_.begin() + tree.bodyEnd, -1);
      continue;
    }
    const int first = sets_.find(t);  // the first tree of its island
    const int island = first == t ? islands++ : ofBody_[idx(model.trees[idx(first)].rootBody)];
    std::fill(ofBody_.begin() + tree.rootBody, ofBody_.begin() + tree.bodyEnd, island);
  }
  bodies_.divide(allBodies(model), islands, [&](int b) { return ofBody_[idx(b)]; });
  dofs_.divide({0, model.nv}, islands,
               [&](int i) { return ofBody_[idx(model.dofs[idx(i)].body)]; });
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/islands/units.hpp"

#include <map>

#include "softgauss/engine/core/union_find.hpp"

namespace softgauss {

Units::Units(const Model& model) : ofTree(model.trees.size(), -1) {
  const int count = static_cast<int>(model.trees.size());
  UnionFind sets(count);
  const auto tie = [&](int bodyA, int bodyB) {
    const int a = model.bodies[static_cast<std::size_t>(bodyA)].tree;
    const int b = model.bodies[static_cast<std::size_t>(bodyB)].tree;
    if (a >= 0 && b >= 0) sets.unite(a, b);
  };
  std::map<int, int> rootOf;  // by robot: the root body of its first tree
  for (const Tree& tree : model.trees) {
    const int robot = model.bodies[static_cast<std::size_t>(tree.rootBody)].robot;
    tie(rootOf.emplace(robot, tree.rootBody).first->second, tree.rootBody);
  }
  for (const Connection& c : model.connections) tie(c.bodyA, c.bodyB);
  for (const Weld& w : model.welds) tie(w.bodyA, w.bodyB);
  for (const JointCoupling& c : model.couplings) tie(c.follower, c.leader);

  for (int t = 0; t < count; ++t) {
    const int first = sets.find(t);
    if (first == t) {
      ofTree[static_cast<std::size_t>(t)] = size();
      trees.emplace_back();
    }
    const int unit = ofTree[static_cast<std::size_t>(first)];
    ofTree[static_cast<std::size_t>(t)] = unit;
    trees[static_cast<std::size_t>(unit)].push_back(t);
  }
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goal_islands.hpp"

namespace softgauss::gdd {

GoalIslands::GoalIslands(const Model& model) : ofTree_(model.trees.size(), 0) {
  controls_.reserve(model.trees.size());
}

/// All, where all are one; else who is tied to somebody who is awake.
void GoalIslands::findWanted(const Model& model, bool together, const Data& data) {
  wanted_.clear();
  if (!data.active.anyStill()) return;
  if (together) {
    wanted_ = data.active.still();
    return;
  }
  for (const auto& [bodyA, bodyB] : data.bodies.tied) {
    const int a = model.bodies[idx(bodyA)].tree, b = model.bodies[idx(bodyB)].tree;
    if (a < 0 || b < 0 || data.active.isStill(a) == data.active.isStill(b)) continue;
    wanted_.resize(model.trees.size(), 0);
    wanted_[idx(data.active.isStill(a) ? a : b)] = 1;
  }
}

bool GoalIslands::find(const Model& model, const ControlLimits& limits, bool together,
                       GoalCost& cost, Data& data) {
  const TreeIslands& islands = data.bodies.islands;
  isOneProblem_ = model.trees.size() > 1 && (together || cost.hasFunctions());
  together = together || model.trees.size() == 1;
  if (!together) {
    data.bodies.tied.clear();
    cost.appendPairs(model, data.constraints, data.bodies.tied);
    limits.appendPairs(model, data.bodies.tied);
  }
  findWanted(model, together || cost.hasFunctions(), data);
  if (!wanted_.empty()) return false;
  if (!together) {
    data.bodies.divide(model, data.inertia, data.active, data.constraints);
    together = islands.size() == 1 && data.active.all();
  }
  isWhole_ = together;
  for (std::size_t t = 0; t < model.trees.size(); ++t)
    ofTree_[t] = together ? 0 : islands.ofBody()[idx(model.trees[t].rootBody)];
  controls_.assign(together ? 1 : idx(islands.size()), 0);
  for (const int t : data.active.trees())
    for (int i = model.trees[idx(t)].firstDof; i < model.trees[idx(t)].dofEnd; ++i)
      controls_[idx(ofTree_[idx(t)])] += limits.lower[i] < limits.upper[i] ? 1 : 0;
  if (!together) cost.divide(model, data.constraints, islands);
  return true;
}

void GoalIslands::addColumns(const Model& model, Data& data) const {
  Constraints& rows = data.constraints;
  if (!rows.columnsComeLater()) return;
  const TreeSparsity& tree = data.inertia.sparsity;
  for (int i = 0; i < size(); ++i) {
    if (!isSolved(i)) continue;
    rows.select(isWhole_ ? -1 : i);
    rows.addColumns(model, data.kinematics, tree);
  }
  rows.selectAll();
  rows.couple(tree);
}

void GoalIslands::select(const Model& model, int island, GoalCost& cost, Data& data) const {
  if (isWhole_) return;
  data.active.select(model, [&](int tree) { return ofTree_[idx(tree)] == island; });
  data.bodies.massFactored = false;
  data.constraints.select(island);
  cost.select(island);
}

void GoalIslands::selectAll(const Model& model, GoalCost& cost, Data& data) const {
  if (isWhole_) return;
  data.active.select(model, [&](int tree) { return ofTree_[idx(tree)] >= 0; });
  data.bodies.massFactored = false;
  data.constraints.selectAll();
  cost.select(-1);
}

}  // namespace softgauss::gdd

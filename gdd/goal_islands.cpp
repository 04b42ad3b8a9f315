// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goal_islands.hpp"

namespace softgauss::gdd {

GoalIslands::GoalIslands(const Model& model) : ofTree_(model.trees.size(), 0) {
  controls_.reserve(model.trees.size());
}

void GoalIslands::find(const Model& model, const ControlLimits& limits, bool together,
                       GoalCost& cost, Data& data) {
  const TreeIslands& islands = data.bodies.islands;
  together = together || model.trees.size() == 1;
  if (!together) {
    data.bodies.tied.clear();
    cost.appendPairs(model, data.constraints, data.bodies.tied);
    limits.appendPairs(model, data.bodies.tied);
    data.bodies.divide(model, data.inertia, data.constraints);
    together = islands.size() == 1;
  }
  for (std::size_t t = 0; t < model.trees.size(); ++t)
    ofTree_[t] = together ? 0 : islands.ofBody()[idx(model.trees[t].rootBody)];
  controls_.assign(together ? 1 : idx(islands.size()), 0);
  for (std::size_t t = 0; t < model.trees.size(); ++t)
    for (int i = model.trees[t].firstDof; i < model.trees[t].dofEnd; ++i)
      controls_[idx(ofTree_[t])] += limits.lower[i] < limits.upper[i] ? 1 : 0;
  if (!together) cost.divide(model, data.constraints, islands);
}

void GoalIslands::addColumns(const Model& model, Data& data) const {
  Constraints& rows = data.constraints;
  if (!rows.columnsComeLater()) return;
  const TreeSparsity& tree = data.inertia.sparsity;
  for (int i = 0; i < size(); ++i) {
    if (!isSolved(i)) continue;
    rows.select(size() > 1 ? i : -1);
    rows.addColumns(model, data.kinematics, tree);
  }
  rows.selectAll();
  rows.couple(tree);
}

void GoalIslands::select(const Model& model, int island, GoalCost& cost, Data& data) const {
  if (size() == 1) return;
  data.active.select(model, [&](int tree) { return ofTree_[idx(tree)] == island; });
  data.bodies.massFactored = false;
  data.constraints.select(island);
  cost.select(island);
}

void GoalIslands::selectAll(const Model& model, GoalCost& cost, Data& data) const {
  if (size() == 1) return;
  data.active.select(model, [](int) { return true; });
  data.bodies.massFactored = false;
  data.constraints.selectAll();
  cost.select(-1);
}

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#include "gdd/goals/effort.hpp"

namespace softgauss::gdd {
namespace {

std::vector<int> dofsThat(const Model& model, bool actuated) {
  std::vector<int> dofs;
  for (int i = 0; i < model.nv; ++i)
    if (model.dofs[i].actuated == actuated) dofs.push_back(i);
  return dofs;
}

}  // namespace

std::vector<int> Effort::actuatedDofs(const Model& model) { return dofsThat(model, true); }
std::vector<int> Effort::rootDofs(const Model& model) { return dofsThat(model, false); }

void Effort::addCost(const GoalContext& context, GoalCost& cost) const {
  for (const int i : dofs) cost.addForcePrice(i, weight * context.data.weights.dof[i]);
}

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/effort.hpp"

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

Effort Effort::rootForces(const Model& model, const ControlLimits& limits) {
  Effort effort({});
  for (int i = 0; i < model.nv; ++i) {
    if (!limits.isRootForce(model, i)) continue;
    if (limits.isPlain(i)) {
      effort.dofs.push_back(i);
      continue;
    }
    const Eigen::Index k = effort.directions.cols();
    effort.directions.conservativeResize(model.nv, k + 1);
    effort.directions.col(k) = limits.transmission->C().row(i).transpose();
  }
  return effort;
}

void Effort::addCost(const GoalContext& context, GoalCost& cost) const {
  const std::vector<double>& inverseInertia = context.data.weights.dof;
  for (const int i : dofs)
    cost.addControlCost(i, weight * inverseInertia[static_cast<std::size_t>(i)]);
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    double share = 0.0;
    for (Eigen::Index i = 0; i < directions.rows(); ++i)
      share += directions(i, k) * directions(i, k) * inverseInertia[static_cast<std::size_t>(i)];
    cost.addControlCost(directions.col(k), weight * share);
  }
}

bool Effort::concerns(const Model& model, int tree) const {
  const Tree& of = model.trees[idx(tree)];
  const bool pays =
      std::ranges::any_of(dofs, [&](int dof) { return dof >= of.firstDof && dof < of.dofEnd; });
  if (pays || directions.size() == 0) return pays;
  return (directions.middleRows(of.firstDof, of.dofEnd - of.firstDof).array() != 0.0).any();
}

}  // namespace softgauss::gdd

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

std::unique_ptr<Goal> Effort::within(const Model& whole, const SubModel& island) const {
  auto part = std::make_unique<Effort>(*this);
  part->dofs.clear();
  for (const int dof : dofs)
    if (const int here = island.dofOf(whole, dof); here >= 0) part->dofs.push_back(here);
  part->directions.resize(island.model.nv, 0);
  VectorX all = VectorX::Zero(whole.nv), c(island.model.nv);
  for (Eigen::Index k = 0; k < directions.cols(); ++k) {
    all = directions.col(k);
    island.gather(whole, all, c);
    if (c.isZero(0.0)) continue;
    if ((c.array() != 0.0).count() != (all.array() != 0.0).count()) Goal::within(whole, island);
    part->directions.conservativeResize(Eigen::NoChange, part->directions.cols() + 1);
    part->directions.rightCols<1>() = c;
  }
  if (part->dofs.empty() && part->directions.cols() == 0) return nullptr;
  return part;
}

}  // namespace softgauss::gdd

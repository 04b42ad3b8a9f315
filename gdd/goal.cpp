// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goal.hpp"

#include <algorithm>

namespace softgauss::gdd {

void Goal::errors(const GoalContext& context, const ContactForces&,
                  std::vector<GoalError>& out) const {
  const std::optional<GoalMark> m = mark(context);
  if (!m) return;
  GoalError distance;
  distance.value = (m->p_WTarget - m->p_WPoint).norm();
  distance.frame = m->frame;
  out.push_back(distance);
}

std::vector<std::string> distinctNames(const std::vector<std::unique_ptr<Goal>>& goals) {
  std::vector<std::string> names;
  for (const auto& goal : goals) {
    const std::string name = goal->name();
    std::string own = name;
    for (int n = 2; std::find(names.begin(), names.end(), own) != names.end(); ++n)
      own = name + " (" + std::to_string(n) + ")";
    names.push_back(own);
  }
  return names;
}

void wake(const Model& model, const Goal& goal, SleepState& sleep) {
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t)
    if (goal.concerns(model, t)) softgauss::wake(sleep, t);
}

}  // namespace softgauss::gdd

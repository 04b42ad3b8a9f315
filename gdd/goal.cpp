// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goal.hpp"

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

void wake(const Model& model, const Goal& goal, SleepState& sleep) {
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t)
    if (goal.concerns(model, t)) softgauss::wake(sleep, t);
}

}  // namespace softgauss::gdd

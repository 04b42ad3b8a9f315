// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goal.hpp"

namespace softgauss::gdd {

std::unique_ptr<Goal> Goal::within(const Model&, const SubModel&) const {
  throw ModelError({}, "goal '" + name() + "'",
                   "concerns all moving bodies together, expected goals of single robots and links "
                   "where islands are solved separately");
}

void Goal::errors(const GoalContext& context, const ContactForces&,
                  std::vector<GoalError>& out) const {
  const std::optional<GoalMark> m = mark(context);
  if (!m) return;
  GoalError distance;
  distance.value = (m->p_WTarget - m->p_WPoint).norm();
  distance.frame = m->frame;
  out.push_back(distance);
}

}  // namespace softgauss::gdd

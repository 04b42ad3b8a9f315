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

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#include "gdd/goal.hpp"

namespace softgauss::gdd {

std::unique_ptr<Goal> Goal::within(const Model&, const SubModel&) const {
  throw ModelError({}, "goal '" + name() + "'",
                   "is one of all that moves together, expected goals of robots and links where "
                   "islands are solved apart");
}

void Goal::figures(const GoalContext& context, const ContactForces&,
                   std::vector<GoalFigure>& out) const {
  const std::optional<GoalMark> m = mark(context);
  if (!m) return;
  GoalFigure distance;
  distance.value = (m->p_WTarget - m->p_WPoint).norm();
  distance.frame = m->frame;
  out.push_back(distance);
}

}  // namespace softgauss::gdd

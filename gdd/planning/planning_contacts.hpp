// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts of which a plan can see slopes.
///
/// A contact of the default material begins at once: its impedance is 0.9 where it touches, and a
/// gap has no slope at all. A plan's contact begins gently, margin apart, and rises over
/// centimetres: what is near is drawn to touch, and forces of touch have slopes. What slides is
/// held back by the convex cone alone, without the law of slip (5.8), whose kinks stop plans far
/// from any minimum: 2 of 8 starts of a hopper come to a hop with it, 6 without. A simulation
/// keeps its own contacts, and a plan comes to them by continuation. Where contacts change, phase I
/// starts from the accelerations of the plan before, which stay as they are while forces change;
/// and goal directed dynamics make a feasible trajectory on the new contacts of the value models of
/// that plan. The better one is gone on with.

#include "softgauss/engine/model/model.hpp"

namespace softgauss::planning {

struct PlanningContacts {
  double margin = 0.005;  ///< [m] apart at which two surfaces begin to push
  double width = 0.05;    ///< [m] over which the impedance rises
  double dMin = 1e-4;     ///< impedance where the contact begins, in (0, 1)
  double dMax = 0.95;     ///< and at the width, in (0, 1)

  /// `own` with this impedance and this share of a pair's margin; friction, dimension and time
  /// constant stay.
  Material material(const Material& own, double share) const;
  /// Throws ModelError where a number is out of its range.
  void check() const;
};

}  // namespace softgauss::planning

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts of a capsule that lies along something: where one point becomes two.
///
/// Along the core segment of a capsule the distance g to a convex shape is convex. Its minimum is
/// the nearest contact; `first` and `last` are contacts at the ends of the stretch on which the two
/// shapes lie side by side. With λ ∈ [0, 1] from "crossing" to "alongside", distances are faded
/// towards the margin m, at which a contact vanishes:
///   ends      m + min(1, 2 λ α) (g_end − m)
///   nearest   m + max(min(1, 2 − 2 λ α), β) (g_min − m)
/// α ∈ [0, 1] falls to 0 where the normal at an end differs from the nearest one (by 8° to 18°; for
/// the nearest contact α is interpolated between the ends): there the end touches something else.
/// β ∈ [0, 1] says how far the minimum dips below the line between the ends: 0 up to 1 % of its
/// depth, 1 from 11 % on. So λ = 0 gives the nearest contact alone; a capsule lying flat (λ = 1, no
/// dip) rests on both ends; where capsules cross at a small angle, all three count; and one contact
/// at least shows 89 % of the depth. Everything is continuous in the poses.

#include <algorithm>

#include "softgauss/collision/pair_contact.hpp"

namespace softgauss::collision {

/// λ of an angle: 1 below about 3°, 0 above about 8°. `sine2` is the sine squared of the angle
/// between the segment and what it may lie along.
inline double alongside(double sine2) {
  constexpr double kAlong = 0.0025, kAcross = 0.02;
  return std::clamp((kAcross - sine2) / (kAcross - kAlong), 0.0, 1.0);
}

/// Adds up to three contacts as above. `fraction` ∈ [0, 1] is the place of the nearest contact
/// between first (0) and last (1).
inline void addSegmentContacts(const PairContact& nearest, const PairContact& first,
                               const PairContact& last, double fraction, double lambda,
                               double margin, PairContacts& out) {
  const double line = first.distance + fraction * (last.distance - first.distance);
  const double depth = margin - nearest.distance;
  const double dip = std::clamp(10.0 * (line - nearest.distance) / depth - 0.1, 0.0, 1.0);
  const auto alignment = [&](const PairContact& end) {
    return std::clamp((end.n_W.dot(nearest.n_W) - 0.95) / 0.04, 0.0, 1.0);
  };
  const double alphaFirst = alignment(first), alphaLast = alignment(last);
  const double alpha = alphaFirst + fraction * (alphaLast - alphaFirst);
  const auto fade = [&](const PairContact& c, double weight) {
    const double distance = margin + weight * (c.distance - margin);
    if (distance < margin) out.add(c.p_WC, c.n_W, distance);
  };
  fade(last, std::min(1.0, 2.0 * lambda * alphaLast));
  fade(first, std::min(1.0, 2.0 * lambda * alphaFirst));
  fade(nearest, std::max(std::min(1.0, 2.0 - 2.0 * lambda * alpha), dip));
}

}  // namespace softgauss::collision

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Exact minimisation of a convex C¹ function along a ray.
///
/// The slope of a convex piecewise quadratic is continuous, increasing and piecewise linear in α,
/// so Newton's method on the slope, kept inside a bracket, lands on the minimiser after finitely
/// many pieces. Other convex functions converge quadratically.

#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/jet.hpp"

namespace softgauss {

struct LineSearchResult {
  double alpha = 0.0;  ///< 0: no descent was possible
  int evaluations = 0;
};

/// Where to look, and how closely.
struct LineSearchOptions {
  double start = 1.0;        ///< first α
  double upper = kInfinity;  ///< α beyond which there is nothing to look for
  double tolerance = 1e-10;  ///< slope at the result over the slope at α = 0
  int maxEvaluations = 60;
};

/// `along(α)` returns a Jet; `slope0` < 0 is the slope at α = 0.
template <class Along>
LineSearchResult exactLineSearch(Along&& along, double slope0,
                                 const LineSearchOptions& options = {}) {
  // Newton lands on the minimiser of a few pieces within as many steps. Where it creeps, next to
  // the apex of a cone, every other step halves the bracket.
  constexpr int kPatience = 16;
  LineSearchResult result;
  if (!(slope0 < 0.0)) return result;
  const double tolerance = options.tolerance * -slope0;
  double lower = 0.0, upper = options.upper, alpha = options.start;
  while (result.evaluations < options.maxEvaluations) {
    const Jet jet = along(alpha);
    ++result.evaluations;
    result.alpha = alpha;
    if (std::abs(jet.slope) <= tolerance || !std::isfinite(jet.slope)) return result;
    (jet.slope < 0.0 ? lower : upper) = alpha;
    double next = jet.curvature > 0.0 ? alpha - jet.slope / jet.curvature : kInfinity;
    const bool creeps = result.evaluations > kPatience && result.evaluations % 2 == 0;
    if (creeps || !(next > lower && next < upper))
      next = std::isfinite(upper) ? 0.5 * (lower + upper) : 2.0 * alpha;
    if (next == alpha) return result;  // the bracket has shrunk to rounding
    alpha = next;
  }
  // Not found: as far as the function is known to fall.
  if (lower > 0.0) result.alpha = lower;
  return result;
}

}  // namespace softgauss

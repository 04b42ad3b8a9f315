// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Exact minimisation of a convex C¹ function along a ray.
///
/// The slope of a convex piecewise quadratic is continuous, increasing and piecewise linear in α,
/// so Newton's method on the slope, kept inside a bracket, lands on the minimiser after finitely
/// many pieces. Other convex functions converge quadratically.

#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/jet.hpp"

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
  LineSearchResult result;
  if (!(slope0 < 0.0)) return result;
  const double tolerance = options.tolerance * -slope0;
  double lower = 0.0, upper = options.upper, alpha = options.start;
  while (result.evaluations < options.maxEvaluations) {
    const Jet jet = along(alpha);
    ++result.evaluations;
    if (std::abs(jet.slope) <= tolerance || !std::isfinite(jet.slope)) break;
    (jet.slope < 0.0 ? lower : upper) = alpha;
    double next = jet.curvature > 0.0 ? alpha - jet.slope / jet.curvature : kInfinity;
    if (!(next > lower && next < upper))
      next = std::isfinite(upper) ? 0.5 * (lower + upper) : 2.0 * alpha;
    if (next == alpha) break;  // the bracket has shrunk to rounding
    alpha = next;
  }
  result.alpha = alpha;
  return result;
}

}  // namespace softgauss

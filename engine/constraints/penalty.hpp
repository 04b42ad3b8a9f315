// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Penalties s(x) on the residual x = J a − a_ref of a scalar row: convex, C¹, piecewise quadratic
/// (T.8). Value, slope and curvature come from the one kernel `at`, so that forward dynamics, its
/// inverse, the line search and goal directed dynamics cannot disagree.

#include <concepts>
#include <limits>

#include "engine/core/check.hpp"
#include "engine/core/jet.hpp"

namespace softgauss {

/// Unilateral constraint: limits, contact normals, edges of a friction pyramid.
///   s(x) = ½ D min(x, 0)²,   force f = −s′(x) = −D min(x, 0) ≥ 0
/// A row is active where x < 0. At the knot x = 0 the curvature is that of the free side.
struct HalfQuadratic {
  static Jet at(double x, double D) {
    const double overshoot = x >= 0.0 ? 0.0 : x;  // NaN stays NaN
    return {0.5 * D * overshoot * overshoot, D * overshoot, x >= 0.0 ? 0.0 : D};
  }
  /// The α ≥ 0 at which x + α dx changes its piece; infinite when it never does.
  static double knotAhead(double x, double dx) {
    const bool leaves = x < 0.0 && dx > 0.0, enters = x >= 0.0 && dx < 0.0;
    return leaves || enters ? -x / dx : kInfinity;
  }
  /// The knot, seen from its stiff side (the smallest x < 0) or its free side.
  static double knot(bool stiffSide) {
    return stiffSide ? -std::numeric_limits<double>::min() : 0.0;
  }
  /// Change of the curvature there, going along dx.
  static double curvatureJump(double dx, double D) { return dx > 0.0 ? -D : D; }
};

template <class P>
concept ScalarPenalty = requires(double x, double dx, double D) {
  { P::at(x, D) } -> std::same_as<Jet>;
  { P::knotAhead(x, dx) } -> std::same_as<double>;
  { P::curvatureJump(dx, D) } -> std::same_as<double>;
  { P::knot(true) } -> std::same_as<double>;
};
static_assert(ScalarPenalty<HalfQuadratic>);

}  // namespace softgauss

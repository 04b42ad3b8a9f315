// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Penalties s(x) on the residual x = J a − a_ref of a scalar row: convex, C¹, piecewise quadratic
/// (1.4). Value, slope and curvature come from the one kernel `at`, so that forward dynamics, its
/// inverse, the line search and goal directed dynamics cannot disagree.
///
/// A penalty's pieces are numbered upwards from x = −∞; breakpoint k lies between the pieces k and
/// k + 1. s″ is D in one piece, the stiff one, and 0 in the others, the free ones. At a breakpoint
/// a row counts as free. The kernel is `in`, the polynomial of one piece; `at` picks the piece by
/// x. A method that walks from cell to cell keeps the pieces itself, for at a breakpoint rounding
/// must not choose.

#include <concepts>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/jet.hpp"

namespace softgauss {

/// Unilateral constraint: limits, contact normals, edges of a friction pyramid.
///   s(x) = ½ D min(x, 0)²,   force f = −s′(x) = −D min(x, 0) ≥ 0
/// A row is active where x < 0; the breakpoint is x = 0.
struct HalfQuadratic {
  static constexpr int kBreakpoints = 1;
  static constexpr bool kLimited = false;
  double D;

  Jet in(int piece, double x) const {
    const double overshoot = piece == 1 ? 0.0 : x;  // NaN stays NaN
    return {0.5 * D * overshoot * overshoot, D * overshoot, piece == 1 ? 0.0 : D};
  }
  Jet at(double x) const { return in(piece(x), x); }
  int piece(double x) const { return x >= 0.0 ? 1 : 0; }
  double breakpoint(int) const { return 0.0; }
  /// s″ above a breakpoint less s″ below it.
  double curvatureJump(int) const { return -D; }
};

/// Bilateral constraint: equalities.   s(x) = ½ D x²,   f = −D x
struct Quadratic {
  static constexpr int kBreakpoints = 0;
  static constexpr bool kLimited = false;
  double D;

  Jet in(int, double x) const { return {0.5 * D * x * x, D * x, D}; }
  Jet at(double x) const { return in(0, x); }
  int piece(double) const { return 0; }
  double breakpoint(int) const { return 0.0; }
  double curvatureJump(int) const { return 0.0; }
};

/// Bilateral constraint whose force is limited: dry friction. With r = limit/D,
///   s(x) = ½ D x² where |x| < r,   limit (|x| − ½ r) beyond;   f = −D x clamped to ± limit
/// The breakpoints are ∓ r; between them the row is stiff.
struct Huber {
  static constexpr int kBreakpoints = 2;
  static constexpr bool kLimited = true;
  double D;
  double limit;  ///< of the force, > 0

  Jet in(int piece, double x) const {
    const double r = limit / D;
    if (piece == 0) return {limit * (-x - 0.5 * r), -limit, 0.0};
    if (piece == 2) return {limit * (x - 0.5 * r), limit, 0.0};
    return {0.5 * D * x * x, D * x, D};
  }
  Jet at(double x) const { return in(piece(x), x); }
  int piece(double x) const { return x <= breakpoint(0) ? 0 : (x >= breakpoint(1) ? 2 : 1); }
  double breakpoint(int k) const { return k == 0 ? -(limit / D) : limit / D; }
  double curvatureJump(int k) const { return k == 0 ? D : -D; }
};

template <class P>
concept ScalarPenalty = requires(const P s, double x, int k) {
  { s.D } -> std::convertible_to<double>;
  { P::kBreakpoints } -> std::convertible_to<int>;
  { P::kLimited } -> std::convertible_to<bool>;
  { s.in(k, x) } -> std::same_as<Jet>;
  { s.at(x) } -> std::same_as<Jet>;
  { s.piece(x) } -> std::same_as<int>;
  { s.breakpoint(k) } -> std::same_as<double>;
  { s.curvatureJump(k) } -> std::same_as<double>;
};
static_assert(ScalarPenalty<HalfQuadratic>);
static_assert(ScalarPenalty<Quadratic>);
static_assert(ScalarPenalty<Huber>);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// One law for every row: a spring and a damper at the end of the step,
///
///   f = max(0, −K (r + t ẋ⁺) − τ K ẋ⁺)           (equalities and friction without the max)
///     = max(0, −D (ẍ − a_ref)),   D = h (t + τ) K,   a_ref = −ẋ/h − (K/D) r              (3.14)
///
/// with t from where r is taken to the step's end. It is passive at any step, for any K and τ that
/// hold while the row lasts, and stiff ones answer within the step. Where a user gives no stiffness
/// the row is near-rigid: of what it feels, A, it leaves 1/(1 + κ) unanswered,
///
///   K = κ/(A h_o (t_o + τ)),   τ = max(2 t_c ζ², ½ h_o)                                  (3.15)
///
/// h_o the whole step, so that parts of a step keep K and τ. An impedance that is given means K and
/// τ of (3.1), no harder than its largest d.
///
/// The n edges of a friction pyramid are as stiff along the tangents as a cone of this law, and no
/// softer together along the normal,
///
///   D_e = e D,   e = max(1/n, impratio/(2 μ²))                                             (3.17)
///
/// Near-rigid ones share the spring, K/n each, so that depth does not depend on friction. A
/// friction below 0.3 counts as 0.3, or overlaps would take ever longer to resolve, n e τ.
///
/// A row begins before it touches, where r ≥ 0 and r + T ẋ < 0, with T from where rows are made to
/// where they are made next: it touches then,
///   a_ref = −ẋ/h − r/(h T)                                                               (3.16)

#include <algorithm>

#include "softgauss/engine/constraints/impedance.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss {

/// κ of rows whose stiffness nobody gave, an impedance of 0.97. With 19 wheels lose more in long
/// steps and light feet sink; harder ones put more minima of goals on kinks.
inline constexpr double kNearRigid = 30.0;
/// κ of the largest impedance, 0.9999.
inline constexpr double kHardest = 9999.0;

/// The row (3.14) of a damper alone, [N s/m] per inverse inertia.
inline Softness implicitDamper(double dampingTimesA, double inverseInertia,
                               const Options& options) {
  Softness s;
  s.perInertia = 1.0 / (options.timestep * dampingTimesA);
  s.R = std::max(kSmallestRegulariser, s.perInertia * inverseInertia);
  s.damping = 1.0 / options.timestep;
  return s;
}

/// The row (3.14) of a spring [N/m] and a damper [N s/m] that are given, on what has the inverse
/// inertia A. Stiff, it swings by more than a radian in a step, and would give back what it was
/// found with: its spring is then that of a whole step later.
inline Softness springLaw(double stiffness, double damping, double inverseInertia,
                          const Options& options) {
  const double h = options.timestep;
  const bool stiff = h * h * stiffness * inverseInertia > 1.0;
  return implicitSpringDamper(stiffness, damping, stiff ? h : timeToStepEnd(options), options);
}

/// The row (3.14) of an impedance, of inverse inertia A.
inline Softness rowLaw(const Impedance& p, double distance, double inverseInertia,
                       const Options& options) {
  const double h = options.rowTimestep();
  const double lead = h / options.timestep * timeToStepEnd(options);
  const double A = inverseInertia;
  double tau = 0.5 * h, K = 0.0;
  if (p == Impedance{}) {
    tau = std::max(tau, 2.0 * p.timeConstant * p.dampingRatio * p.dampingRatio);
    K = kNearRigid / (A * h * (lead + tau));
  } else {
    const Softness s = softnessAt(p, distance, A, h);
    K = s.stiffness / s.R;
    const double B = s.damping / s.R;
    if (!(K > 0.0)) return implicitDamper(std::min(B * A, kHardest / h), A, options);
    tau = std::max(tau, B / K);
    K = std::min(K, kHardest / (A * h * (lead + tau)));
  }
  Softness s = implicitSpringDamper(K, tau * K, timeToStepEnd(options), options);
  s.R = std::max(kSmallestRegulariser, s.R);
  s.perInertia = s.R / A;
  return s;
}

/// (3.17): an edge of the pyramid of a contact whose law is `s`, of the impedance `p`.
inline Softness edgeOf(const Softness& s, const Impedance& p, int frictionDim, double friction,
                       double impedanceRatio) {
  constexpr double kSlippery = 0.3;
  const double n = 2.0 * frictionDim, mu = std::max(friction, kSlippery);
  const double e = std::max(1.0 / n, impedanceRatio / (2.0 * mu * mu));
  Softness edge = s.hardened(e);
  if (p == Impedance{}) edge.stiffness /= n * e;
  return edge;
}

/// The row (3.14) of joint friction, which has no spring: D = κ/A. Where nobody gave its softness κ
/// is that of the default impedance at no depth, 9 (3.7); harder, goals would find fewer of their
/// global minima, and what sticks is hardened by (5.6) anyway.
inline Softness frictionLaw(const Impedance& p, double inverseInertia, const Options& options) {
  const Softness s = softnessAt(p, 0.0, 1.0, options.rowTimestep());
  const double kappa =
      p == Impedance{} ? 1.0 / s.R : std::min(kHardest, options.timestep * s.damping / s.R);
  return implicitDamper(kappa / options.timestep, inverseInertia, options);
}

/// (3.16) for a row that is not touched yet.
inline Softness beginning(Softness s, const Options& options) {
  s.stiffness = 1.0 / (options.timestep * options.timeToNextRows());
  return s;
}

/// Whether a row of this distance and rate begins before rows are made again.
inline bool begins(double distance, double rate, const Options& options) {
  return distance >= 0.0 && distance + options.timeToNextRows() * rate < 0.0;
}

}  // namespace softgauss

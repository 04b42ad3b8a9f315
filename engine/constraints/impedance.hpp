// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From the parameters of an Impedance to the numbers of a row (3.1), (3.2).
///
/// With distance r (negative when violated, measured from the margin) and row velocity ẋ = J v:
///   d(r)   impedance, rises from dMin at r = 0 to dMax at |r| ≥ width
///   R      = (1 − d)/d · A          regulariser; A approximates J M⁻¹ Jᵀ
///   k      = 1/(dMax² tc² ζ²),  b = 2/(dMax tc)     or, given directly (3.3),
///   k      = stiffness/dMax²,   b = damping/dMax
///   a_ref  = −b ẋ − k d r            so that ẍ + b ẋ + k d r = 0 where the row is hard
/// The force at acceleration x̂ is f = D (a_ref − x̂) with D = 1/R.
///
/// tc is at least two steps, as MuJoCo's is. As rows of the leapfrog the spring K = k d/R and the
/// damper B = b/R hold at the end of the step (3.14), whatever they are, and nothing is returned
/// faster than it came; what bounces is bounded by the step (contact_softness.hpp, 3.5).
/// Other integrators, and `--compatibility mujoco`, take them where the step begins, as MuJoCo
/// does: there a stiff and little damped reference needs a short step.

#include <algorithm>
#include <cmath>

#include "softgauss/engine/model/model.hpp"

namespace softgauss {

inline constexpr double kSmallestRegulariser = 1e-15;

/// Regulariser and reference spring-damper of a row at the present distance.
struct Softness {
  double R = 0.0;           ///< regulariser [1/kg or 1/(kg m²)]
  double perInertia = 0.0;  ///< R per inverse inertia A; 0 where A has no part in it [-]
  double stiffness = 0.0;   ///< k d [1/s²]
  double damping = 0.0;     ///< b [1/s]

  double referenceAcceleration(double velocity, double distance) const {
    return -damping * velocity - stiffness * distance;
  }
  /// The row with so many times the D, and the same reference.
  Softness hardened(double times) const {
    Softness s = *this;
    s.R = std::max(kSmallestRegulariser, R / times);
    s.perInertia /= times;
    return s;
  }
};

/// d(r) ∈ (0, 1).
inline double impedanceAt(const Impedance& p, double distance) {
  const auto clamp = [](double d) { return std::clamp(d, 1e-4, 0.9999); };
  const double dMin = clamp(p.dMin), dMax = clamp(p.dMax), mid = clamp(p.midpoint);
  if (dMin == dMax || p.width <= 1e-15) return 0.5 * (dMin + dMax);
  const double x = std::abs(distance) / p.width;
  if (x >= 1.0) return dMax;
  const double power = std::max(1.0, p.power);
  double y = x;
  if (power == 2.0)
    y = x <= mid ? x * x / mid : 1.0 - (1.0 - x) * (1.0 - x) / (1.0 - mid);
  else if (power > 1.0)
    y = x <= mid ? std::pow(x, power) / std::pow(mid, power - 1.0)
                 : 1.0 - std::pow(1.0 - x, power) / std::pow(1.0 - mid, power - 1.0);
  return dMin + y * (dMax - dMin);
}

/// The impedance of a contact between two surfaces (3.13): the mean of all parameters, `share` that
/// of the first. A reference that is given directly replaces one that is not; of two, the stiffer
/// and the more damped.
inline Impedance mixImpedances(const Impedance& p, const Impedance& q, double share = 0.5) {
  const auto mean = [share](double a, double b) { return share * a + (1.0 - share) * b; };
  Impedance m{mean(p.timeConstant, q.timeConstant),
              mean(p.dampingRatio, q.dampingRatio),
              mean(p.dMin, q.dMin),
              mean(p.dMax, q.dMax),
              mean(p.width, q.width),
              mean(p.midpoint, q.midpoint),
              mean(p.power, q.power),
              p.direct ? p.direct : q.direct};
  if (p.direct && q.direct)
    m.direct = {std::max(p.direct->stiffness, q.direct->stiffness),
                std::max(p.direct->damping, q.direct->damping)};
  return m;
}

/// `inverseInertia` is A. The time constant is at least two steps.
inline Softness softnessAt(const Impedance& p, double distance, double inverseInertia,
                           double timestep) {
  const double d = impedanceAt(p, distance);
  const double dMax = std::clamp(p.dMax, 1e-4, 0.9999);
  Softness s;
  s.perInertia = (1.0 - d) / d;
  s.R = std::max(kSmallestRegulariser, s.perInertia * inverseInertia);
  if (p.direct) {
    s.stiffness = p.direct->stiffness * d / (dMax * dMax);
    s.damping = p.direct->damping / dMax;
    return s;
  }
  const double tc = std::max(p.timeConstant, 2.0 * timestep);
  const double root = dMax * tc * p.dampingRatio;
  s.damping = 2.0 / (dMax * tc);
  s.stiffness = d / (root * root);
  return s;
}

/// From where positions are taken to the step's end [s]: the leapfrog takes them at mid-step.
inline double timeToStepEnd(const Options& options) {
  return options.integrator == Integrator::leapfrog ? 0.5 * options.timestep : options.timestep;
}

/// The row whose spring K is that of `t` [s] after its r and whose damper B is that of the step's
/// end, r + t ẋ⁺ and ẋ⁺ = ẋ + h ẍ:
///
///   f = −K (r + t ẋ⁺) − B ẋ⁺ = −D (ẍ + ẋ/h + (K/D) r),     D = h (t K + B)                (3.14)
///
/// It has no more mass than its force has work to do: K and B may change from step to step, and
/// nothing is gained by it.
inline Softness implicitSpringDamper(double K, double B, double t, const Options& options) {
  const double h = options.timestep, D = h * (t * K + B);
  Softness s;
  s.R = 1.0 / D;
  s.stiffness = K / D;
  s.damping = 1.0 / h;
  return s;
}

/// The row with the same spring k d/R and damper b/R, likewise.
inline Softness implicitSpringDamper(const Softness& s, double t, const Options& options) {
  if (!(s.damping > 0.0)) return s;
  Softness atEnd = implicitSpringDamper(s.stiffness / s.R, s.damping / s.R, t, options);
  atEnd.perInertia = s.perInertia * (atEnd.R / s.R);
  return atEnd;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// From the parameters of an Impedance to the numbers of a row (T.10, T.11).
///
/// With distance r (negative when violated, measured from the margin) and row velocity ẋ = J v:
///   d(r)   impedance, rises from dMin at r = 0 to dMax at |r| ≥ width
///   R      = (1 − d)/d · A          regulariser; A approximates J M⁻¹ Jᵀ
///   k      = 1/(dMax² tc² ζ²),  b = 2/(dMax tc)
///   a_ref  = −b ẋ − k d r            so that ẍ + b ẋ + k d r = 0 where the row is hard
/// The force at acceleration x̂ is f = D (a_ref − x̂) with D = 1/R.

#include <algorithm>
#include <cmath>

#include "engine/model/material.hpp"

namespace softgauss {

/// Regulariser and reference spring-damper of a row at the present distance.
struct Softness {
  double R = 0.0;          ///< regulariser [1/kg or 1/(kg m²)]
  double stiffness = 0.0;  ///< k d [1/s²]
  double damping = 0.0;    ///< b [1/s]

  double referenceAcceleration(double velocity, double distance) const {
    return -damping * velocity - stiffness * distance;
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

/// `inverseInertia` is A; `timestep` bounds the time constant from below by 2h, below which an
/// explicit step cannot follow the reference spring-damper.
inline Softness softnessAt(const Impedance& p, double distance, double inverseInertia,
                           double timestep) {
  const double d = impedanceAt(p, distance);
  const double dMax = std::clamp(p.dMax, 1e-4, 0.9999);
  const double tc = std::max(p.timeConstant, 2.0 * timestep);
  const double root = dMax * tc * p.dampingRatio;
  Softness s;
  s.R = std::max(1e-15, (1.0 - d) / d * inverseInertia);
  s.stiffness = d / (root * root);
  s.damping = 2.0 / (dMax * tc);
  return s;
}

}  // namespace softgauss

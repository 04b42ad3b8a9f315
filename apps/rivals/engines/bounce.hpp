// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What engines without a coefficient of restitution bounce on.

#include <cmath>

#include "apps/rivals/scene.hpp"

namespace rivals {

/// Damping ratio of a spring of natural frequency `omega` [rad/s] on which the first body leaves
/// its first impact with the scene's restitution: e = exp(−2 ζ/√(1 − ζ²) atan(√(1 − ζ²)/ζ)), less
/// what gravity takes while the impact lasts, 3.5 ζ g/(ω v). At least 0.
inline double dampingOfBounce(const Scene& scene, double omega) {
  const double gravity = scene.gravity.norm() / (omega * scene.fallSpeed());
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double zeta = 0.5 * (low + high), root = std::sqrt(1.0 - zeta * zeta);
    const double e = std::exp(-2.0 * zeta / root * std::atan(root / zeta));
    (e - 3.5 * zeta * gravity > scene.restitution ? low : high) = zeta;
  }
  return low;
}

}  // namespace rivals

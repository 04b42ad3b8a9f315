// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A minimum-jerk line that goes on from another: from a place, a velocity and an acceleration to a
/// place where it comes to rest, in the duration T, s = (t − t₀)/T in [0, 1]:
///   r = p₀ + (p* − p₀)(10 s³ − 15 s⁴ + 6 s⁵) + T ṙ₀ (s − 6 s³ + 8 s⁴ − 3 s⁵)
///          + ½ T² r̈₀ (s² − 3 s³ + 3 s⁴ − s⁵)
/// From rest it is the line of Flash and Hogan (9.3).

#include "softgauss/engine/core/types.hpp"

namespace softgauss::live {

struct BegunLine {
  Vector3 p_start = Vector3::Zero();   ///< p₀ [m]
  Vector3 v_start = Vector3::Zero();   ///< ṙ₀ [m/s]
  Vector3 a_start = Vector3::Zero();   ///< r̈₀ [m/s²]
  Vector3 p_target = Vector3::Zero();  ///< p* [m]
  double startTime = 0.0;              ///< t₀ [s]
  double duration = 1.0;               ///< T [s]

  struct Point {
    Vector3 p, v, a;  ///< [m, m/s, m/s²]
  };
  /// At a time [s]; as at the start before it, at rest after the end.
  Point at(double time) const;
  /// From `time` on it goes to another place, in the same duration, without a jump.
  void turnTo(const Vector3& p_WTarget, double time);
};

}  // namespace softgauss::live

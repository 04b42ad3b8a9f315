// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Heaps come to rest: contacts that carry others harden where they stick.
///
/// A soft friction force needs a slip of its reference to exist, and at rest that is a speed: under
/// a load that it holds a contact creeps, by some u = R N/(n b), N its normal force and n its rows
/// that push along the normal. A body that stands alone glides slowly; in a heap each takes others
/// along, until one tips. So where a contact carries other trees (L > 0 in (T.80)) its rows harden
/// as it slows down (T.97):
///   ρ = clamp(max(s/(c_t u), |ẏ_n|/(c_n u)), ρ_min, 1),   s = |(μ_k ẏ_k)|
///   u = (k d |r| + g R/(n A))/b      by its depth, and by the weight that it is made for
///   R ← ρ R,   k d ← ρ k d
/// A row pushes with f = −D (y + b ẏ + k d r). So D k d |r|, the force of what is at rest, stays as
/// it was, and the speed that a change of load needs falls by ρ. While it sticks, s dies out as
/// fast as e^{−b t} less the share s/(c_t u) that it has at ρ = 1. ρ depends on q and v alone, so
/// the inverse (T.2) stays explicit; what moves faster is as it was, bit for bit.
///
/// Along the normal a contact then holds its depth where that bears the load to c_n; it is as soft
/// as before where the depth has farther to go.

#include <algorithm>

#include "engine/constraints/impedance.hpp"

namespace softgauss {

/// How fast a contact slips, and how fast it creeps by its softness [m/s].
struct SlipSpeeds {
  double tangential = 0.0;  ///< s
  double normal = 0.0;      ///< |ẏ_n|
  double creep = 0.0;       ///< u

  /// ρ.
  double slip() const {
    // The last edge of a pyramid of n edges creeps at ((n − 2) τ/(1 − τ) − 1) u under the share τ
    // of what friction holds: by 200 u at 99 % with condim 3, 96 % with condim 6.
    constexpr double kTangential = 200.0;
    constexpr double kNormal = 0.1;
    constexpr double kLeast = 1e-6;
    const double speed = std::max(tangential / kTangential, normal / kNormal);
    if (!(speed < creep)) return 1.0;  // also NaN
    return std::max(kLeast, speed / creep);
  }
};

/// The rows of a contact that slips by ρ.
inline Softness sticking(Softness s, double slip) {
  s.R = std::max(kSmallestRegulariser, slip * s.R);
  s.perInertia *= slip;
  s.stiffness *= slip;
  return s;
}

}  // namespace softgauss

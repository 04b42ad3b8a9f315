// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts that stick harden, until nothing is left to creep by.
///
/// A soft friction force needs a slip of its reference to exist, and at rest that is a speed: under
/// a load that it holds a contact creeps. So rows of contacts harden as they slow down (5.7). With
/// n rows that push along the normal, s = |(μ_k ẏ_k)|,
///   w = g R/(n A b),   u = k d |r|/b + w       creep by the weight it is made for, and its depth's
///   ρ = clamp(max(s/(c_t u), (|ẏ_n| − a)/(c_n w)), ρ_min, 1)
///   R ← ρ R,   k d ← ρ k d
/// A row pushes with f = −D (y + b ẏ + k d r). So D k d |r|, the force of what is at rest, stays as
/// it was, and the speed that a load needs falls by ρ: under one that creeps by c u at ρ = 1,
/// ṡ = −b s (1 − c/c_t), and at rest nothing is left to creep by. What slides by less than c_t u
/// meets Coulomb's force, whatever its speed. ρ depends on q and v alone, so the inverse (1.2)
/// stays explicit; what moves faster is as it was, bit for bit.
///
/// The last edge of a pyramid of n edges creeps by c = (n − 2) τ/(1 − τ) − 1 under the share τ of
/// what friction holds: by 200 at 99 % with condim 3, 96 % with condim 6. A cone of ratio μ̂ creeps
/// by c = τ μ̂² at most. What is faster slides, and its rows must not be hard: they would push it
/// off by its slip.
///
/// Along the normal a contact then keeps its depth where that is off by less than c_n of the depth
/// under its own weight; where it has farther to go it is as soft as before. Friction moves it
/// along the normal, too, where it carries much: edges of a pyramid, and contacts of a body, leave
/// their load to others. That is no way to go, and ends with the slip:
///   a = min(c_s s max(0, 1 − V), u − w, w)     where friction holds a weight, else 0
/// What bounces is left alone: springs of contacts, and references that are less than critically
/// damped, b² < 4 k d.

#include <algorithm>

#include "softgauss/engine/constraints/impedance.hpp"

namespace softgauss {

/// How far a contact may be hardened, and off its depth.
struct Hardening {
  double settled;  ///< c_n
  double least;    ///< ρ_min
};
/// A contact that carries no other tree lies as deep as its load asks, to 0.1 %. The matrix that
/// solver 1 factors has ρ⁻².
inline constexpr Hardening kAlone{0.001, 1e-4};
/// One that does: creep of one contact moves others along their normals. With 0.05 a heap of 200
/// takes ten seconds to rest, with 0.1 two or three. Towers sink by so much more (decision 0030).
inline constexpr Hardening kCarries{0.06, 1e-5};

/// c_t of a pyramid's edges.
inline constexpr double kEdgeCreep = 200.0;

/// c_t of a cone of ratio μ̂: twice what it creeps by at most, so that s dies out by b/2 at least.
inline double coneCreep(double ratio) { return 2.0 * ratio * ratio; }

/// ρ_min of contacts of trees that goals control: harder ones cost the solve digits of a.
inline constexpr double kLeastUnderGoals = 1e-2;

/// How fast a contact moves, and how fast it creeps by its softness [m/s].
struct ContactSpeeds {
  double tangential = 0.0;         ///< s
  double normal = 0.0;             ///< |ẏ_n|
  double creep = 0.0;              ///< u
  double weight = 0.0;             ///< w
  double sticks = 0.0;             ///< max(0, 1 − V) where friction holds a weight, else 0
  double slidesFrom = kEdgeCreep;  ///< c_t

  /// ρ.
  double regularisationScale(const Hardening& most) const {
    // Measured: with 8 some slopes creep on, with 14 a capsule in a groove jitters.
    constexpr double kWithSlip = 10.0;
    const double byFriction = std::min({kWithSlip * sticks * tangential, creep - weight, weight});
    const double way = std::max(0.0, normal - byFriction);
    const double scale = std::max(tangential / (slidesFrom * creep), way / (most.settled * weight));
    return scale < 1.0 ? std::max(most.least, scale) : 1.0;  // also NaN
  }
};

/// The rows of a contact that slips by ρ.
inline Softness stiffened(Softness s, double scale) {
  s.R = std::max(kSmallestRegulariser, scale * s.R);
  s.perInertia *= scale;
  s.stiffness *= scale;
  return s;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How two rigid bodies move, by elliptic functions: one that nothing turns, and a heavy symmetric
/// top [Landau, Lifshitz, Mechanics, §35 and §37]. What turns about the fixed axis is an integral
/// of a smooth function of time, taken by Gauss' rule to rounding.

#include "softgauss/engine/core/types.hpp"

namespace softgauss::app {

/// A rotation and its rate.
struct Turn {
  Matrix3 R_WB;  ///< body axes in world axes
  Vector3 w_B;   ///< angular velocity in body axes [rad/s]
};

/// Of a body with the principal moments I.x > I.y > I.z [kg m²] that turns with w at t = 0, in body
/// axes, and has |L|² > 2 T I.y; its axes are the world's at t = 0.
///
///   w_x = A_x dn u,  w_y = A_y sn u,  w_z = A_z cn u,    u = s t + u₀
Turn freeTurn(const Vector3& I, const Vector3& w, double t);

/// Euler angles about z, x′, z″ of a top and their rates.
struct TopAngles {
  double precession, tilt, spin;              ///< [rad]
  double precessionRate, tiltRate, spinRate;  ///< [rad/s]
};

/// Of a top that is let go at a tilt with nothing but spin. `moment`: across, about the tip;
/// `axial`: along [kg m²]; `weight`: mass times gravity times height [N m]. z is up.
///
///   cos θ = c₁ + (c₀ − c₁) cd² s t,    c₀ = cos θ(0)
TopAngles topAngles(double moment, double axial, double weight, double tilt, double spin, double t);

}  // namespace softgauss::app

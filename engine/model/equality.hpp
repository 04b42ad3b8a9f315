// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What may be tied to what besides by joints: points, poses, joint coordinates. Parameters only;
/// the rows are made in constraints/.

#include <array>

#include "softgauss/engine/core/spatial.hpp"
#include "softgauss/engine/model/material.hpp"

namespace softgauss {

/// Where MuJoCo's model takes the weights of two tied bodies: their centres of mass, or those of
/// links that are fixed to others, which are bodies to it [m].
struct TieCenters {
  Vector3 inA = Vector3::Zero();  ///< in body A
  Vector3 inB = Vector3::Zero();  ///< in body B
};

/// A point of body A and a point of body B coincide, as in a ball joint.
struct Connection {
  int bodyA = 0, bodyB = 0;
  Vector3 p_AP = Vector3::Zero();  ///< in body A [m]
  Vector3 p_BP = Vector3::Zero();  ///< in body B [m]
  Impedance impedance;
  TieCenters centers;
};

/// A frame of body A and a frame of body B coincide.
struct Weld {
  int bodyA = 0, bodyB = 0;
  Transform X_AF;
  Transform X_BF;
  double torqueScale = 1.0;  ///< [m] how much a rotation counts against a distance
  Impedance impedance;
  TieCenters centers;
};

/// q_follower = c₀ + c₁ q_leader + … + c₄ q_leader⁴. A mimic joint of a URDF has c = (offset,
/// multiplier, 0, 0, 0).
struct JointCoupling {
  int follower = 0;                                 ///< body of the joint that follows
  int leader = 0;                                   ///< body of the other; 0: q_follower = c₀
  std::array<double, 5> polynomial{0, 1, 0, 0, 0};  ///< c₀ … c₄
  Impedance impedance;

  double value(double q) const {
    const auto& c = polynomial;
    return c[0] + q * (c[1] + q * (c[2] + q * (c[3] + q * c[4])));
  }
  double slope(double q) const {
    const auto& c = polynomial;
    return c[1] + q * (2.0 * c[2] + q * (3.0 * c[3] + q * 4.0 * c[4]));
  }
  double curvature(double q) const {
    const auto& c = polynomial;
    return 2.0 * c[2] + q * (6.0 * c[3] + q * 12.0 * c[4]);
  }
};

}  // namespace softgauss

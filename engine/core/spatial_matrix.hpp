// SPDX-License-Identifier: Apache-2.0
#pragma once
/// Spatial quantities as 6-vectors and 6 × 6 matrices, for algorithms that factorise them: the
/// angular part first (Featherstone, Rigid Body Dynamics Algorithms, 2008, section 2).

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/core/spatial.hpp"

namespace softgauss {

/// (ω, v) [rad/s, m/s].
inline Vector6 stacked(const Motion& m) {
  Vector6 x;
  x << m.angular, m.linear;
  return x;
}

/// (n, f) [N m, N].
inline Vector6 stacked(const Force& f) {
  Vector6 x;
  x << f.moment, f.force;
  return x;
}

/// Symmetric; stacked(I * m) = spatialMatrix(I) stacked(m).
inline Matrix6 spatialMatrix(const Inertia& I) {
  Matrix6 m;
  m.topLeftCorner<3, 3>() = I.I_O.matrix();
  m.topRightCorner<3, 3>() = skew(I.h);
  m.bottomLeftCorner<3, 3>() = -skew(I.h);
  m.bottomRightCorner<3, 3>() = I.mass * Matrix3::Identity();
  return m;
}

}  // namespace softgauss

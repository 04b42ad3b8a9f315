// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Principal axes of an inertia, as MuJoCo finds them.
///
/// Jacobi's method with the rotation as a unit quaternion. It ends where the largest turn left is
/// below 1.4e-6 rad, cos = 1 − 1e-12, so that R diag(moments) Rᵀ, which is what is simulated,
/// differs from the inertia that was given by some 1e-8 of it.

#include "softgauss/engine/core/types.hpp"

namespace softgauss::io::mjcf {

struct PrincipalAxes {
  Vector3 moments = Vector3::Zero();  ///< in falling order
  Matrix3 R = Matrix3::Identity();    ///< axes, in columns
  Matrix3 tensor() const { return R * moments.asDiagonal() * R.transpose(); }
};

PrincipalAxes principalAxes(const Matrix3& inertia);

}  // namespace softgauss::io::mjcf

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Jacobians of points: v_P = J v, a_P = J v̇ + J̇ v  (J̇ v: pointBiasAcceleration()).

#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss {

/// Velocity that unit speed of dof i gives to the point r (from O) of a body it moves.
inline Vector3 dofPointVelocity(const Motion& S, const Vector3& r) {
  return S.linear + S.angular.cross(r);
}

/// (3 × nv) world translation Jacobian of the point of `body` that is now at p_WP.
void pointJacobian(const Model& model, const Kinematics& k, int body, const Vector3& p_WP,
                   Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> J);

/// (3 × nv) world rotation Jacobian of `body`: ω = J v.
void rotationJacobian(const Model& model, const Kinematics& k, int body,
                      Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> J);

}  // namespace softgauss

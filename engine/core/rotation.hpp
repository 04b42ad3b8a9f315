// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Rotations: exponential and logarithm of SO(3), roll-pitch-yaw, rotation about an axis.
///
/// A rotation vector φ [rad] stands for the rotation by |φ| about φ/|φ|. Quaternions are unit and
/// written w first wherever they are stored as numbers.

#include <cmath>

#include "softgauss/engine/core/types.hpp"

namespace softgauss {

/// Cross-product matrix [a]×, so that skew(a) b = a × b.
inline Matrix3 skew(const Vector3& a) {
  Matrix3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// Unit quaternion exp(φ/2) of a rotation vector φ [rad]. Taylor series near zero.
inline Quaternion quaternionExp(const Vector3& phi) {
  const double angle2 = phi.squaredNorm();
  const double angle = std::sqrt(angle2);
  // sin(θ/2)/θ = 1/2 − θ²/48 + θ⁴/3840; below 1e-3 rad the next term is under 1e-22.
  const double scale =
      angle < 1e-3 ? 0.5 - angle2 / 48.0 + angle2 * angle2 / 3840.0 : std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), scale * phi.x(), scale * phi.y(), scale * phi.z()};
}

/// Rotation vector φ [rad], |φ| ≤ π, of a unit quaternion.
inline Vector3 quaternionLog(const Quaternion& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;  // the shorter of the two rotations
  const Vector3 v = sign * q.vec();
  const double s = v.norm();
  const double w = sign * q.w();
  // 2 atan2(s, w)/s → 2/w (1 − s²/(3 w²)) for small s.
  const double scale =
      s < 1e-5 ? 2.0 / w * (1.0 - s * s / (3.0 * w * w)) : 2.0 * std::atan2(s, w) / s;
  return scale * v;
}

/// φ̇ = dexp⁻¹_φ(ω) of R = R₀ exp(φ) that turns with ω in its own axes (6.6):
///   φ̇ = ω + ½ φ × ω + (1 − ½ θ cot ½θ)/θ² φ × (φ × ω),   θ = |φ| < 2π
inline Vector3 rotationRate(const Vector3& phi, const Vector3& omega) {
  const double angle2 = phi.squaredNorm();
  const double half = 0.5 * std::sqrt(angle2);
  // 1/12 + θ²/720 + θ⁴/30240; below 0.02 rad the next term is under 1e-16.
  const double scale = angle2 < 4e-4 ? 1.0 / 12.0 + angle2 / 720.0 + angle2 * angle2 / 30240.0
                                     : (1.0 - half * std::cos(half) / std::sin(half)) / angle2;
  const Vector3 turn = phi.cross(omega);
  return omega + 0.5 * turn + scale * phi.cross(turn);
}

/// Rotation by `angle` [rad] about the unit vector `axis` (Rodrigues).
inline Matrix3 axisRotation(const Vector3& axis, double angle) {
  const double s = std::sin(angle), c = std::cos(angle), t = 1.0 - c;
  const double x = axis.x(), y = axis.y(), z = axis.z();
  Matrix3 R;
  R << t * x * x + c, t * x * y - s * z, t * x * z + s * y,  //
      t * x * y + s * z, t * y * y + c, t * y * z - s * x,   //
      t * x * z - s * y, t * y * z + s * x, t * z * z + c;
  return R;
}

/// URDF's fixed-axis roll, pitch, yaw [rad]: R = Rz(yaw) Ry(pitch) Rx(roll).
inline Matrix3 rpyRotation(const Vector3& rpy) {
  return axisRotation(Vector3::UnitZ(), rpy.z()) * axisRotation(Vector3::UnitY(), rpy.y()) *
         axisRotation(Vector3::UnitX(), rpy.x());
}

/// A right-handed orthonormal frame whose first column is the unit vector n (MuJoCo's choice of
/// tangents, so that pyramids can be compared: y axis unless n is near it, then z axis).
inline Matrix3 frameFromNormal(const Vector3& n) {
  const Vector3 hint = std::abs(n.y()) < 0.5 ? Vector3::UnitY() : Vector3::UnitZ();
  const Vector3 t1 = (hint - n * n.dot(hint)).normalized();
  Matrix3 R;
  R << n, t1, n.cross(t1);
  return R;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Spatial (6D) algebra after Featherstone, Rigid Body Dynamics Algorithms (2008), chapter 2.
///
/// Angular part first. In the dynamics every spatial vector of a kinematic tree is written in
/// world axes about one point O of that tree (the origin of its root body, at this instant). All
/// bodies then share one coordinate system, so the tree recursions add vectors without transforms.

#include "softgauss/engine/core/types.hpp"

namespace softgauss {

/// Spatial motion: angular velocity ω [rad/s] and the velocity v_O [m/s] of the body-fixed point
/// that passes O (or their rates: accelerations).
struct Motion {
  Vector3 angular = Vector3::Zero();
  Vector3 linear = Vector3::Zero();

  Motion operator+(const Motion& o) const { return {angular + o.angular, linear + o.linear}; }
  Motion operator-(const Motion& o) const { return {angular - o.angular, linear - o.linear}; }
  Motion operator*(double s) const { return {angular * s, linear * s}; }
  Motion& operator+=(const Motion& o) {
    angular += o.angular;
    linear += o.linear;
    return *this;
  }
};

/// Spatial force: moment about O [N m] and force [N].
struct Force {
  Vector3 moment = Vector3::Zero();
  Vector3 force = Vector3::Zero();

  Force operator+(const Force& o) const { return {moment + o.moment, force + o.force}; }
  Force operator-(const Force& o) const { return {moment - o.moment, force - o.force}; }
  Force& operator+=(const Force& o) {
    moment += o.moment;
    force += o.force;
    return *this;
  }
};

/// Power of a force on a motion [W].
inline double dot(const Motion& m, const Force& f) {
  return m.angular.dot(f.moment) + m.linear.dot(f.force);
}

/// m1 × m2: rate of a motion m2 that is carried along by m1.
[[gnu::always_inline]] inline Motion cross(const Motion& a, const Motion& b) {
  return {a.angular.cross(b.angular), a.angular.cross(b.linear) + a.linear.cross(b.angular)};
}

/// m ×* f: rate of a force f that is carried along by m.
inline Force crossForce(const Motion& m, const Force& f) {
  return {m.angular.cross(f.moment) + m.linear.cross(f.force), m.angular.cross(f.force)};
}

/// Pose X_AB of a frame B in a frame A: p_A = R p_B + p.
struct Transform {
  Matrix3 R = Matrix3::Identity();
  Vector3 p = Vector3::Zero();

  Transform operator*(const Transform& o) const { return {R * o.R, R * o.p + p}; }
  Vector3 operator*(const Vector3& x) const { return R * x + p; }
  Transform inverse() const { return {R.transpose(), -(R.transpose() * p)}; }
};

/// Symmetric 3×3 matrix, six numbers.
struct Symmetric3 {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  static Symmetric3 fromMatrix(const Matrix3& m) {
    return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
  }
  Matrix3 matrix() const {
    Matrix3 m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
  }
  Vector3 operator*(const Vector3& v) const {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
  }
  Symmetric3& operator+=(const Symmetric3& o) {
    xx += o.xx, yy += o.yy, zz += o.zz, xy += o.xy, xz += o.xz, yz += o.yz;
    return *this;
  }
};

/// Spatial inertia about a point O: mass m [kg], first moment h = m c [kg m] and rotational
/// inertia about O [kg m²]; c is the centre of mass from O. I V = (I_O ω + h × v, m v − h × ω).
struct Inertia {
  double mass = 0.0;
  Vector3 h = Vector3::Zero();
  Symmetric3 I_O;

  [[gnu::always_inline]] Force operator*(const Motion& V) const {
    return {I_O * V.angular + h.cross(V.linear), mass * V.linear - h.cross(V.angular)};
  }
  Inertia& operator+=(const Inertia& o) {
    mass += o.mass;
    h += o.h;
    I_O += o.I_O;
    return *this;
  }
  /// Inertia of mass m with centre of mass c (from O) and central inertia I_c.
  static Inertia fromCentral(double mass, const Vector3& c, const Symmetric3& I_c) {
    const double xx = mass * c.x() * c.x(), yy = mass * c.y() * c.y(), zz = mass * c.z() * c.z();
    Inertia I;
    I.mass = mass;
    I.h = mass * c;
    I.I_O = {I_c.xx + yy + zz,
             I_c.yy + xx + zz,
             I_c.zz + xx + yy,
             I_c.xy - mass * c.x() * c.y(),
             I_c.xz - mass * c.x() * c.z(),
             I_c.yz - mass * c.y() * c.z()};
    return I;
  }
};

/// R S Rᵀ for a symmetric S.
inline Symmetric3 rotated(const Matrix3& R, const Symmetric3& S) {
  const Matrix3 SRt = S.matrix() * R.transpose();
  return {R.row(0).dot(SRt.col(0)), R.row(1).dot(SRt.col(1)), R.row(2).dot(SRt.col(2)),
          R.row(0).dot(SRt.col(1)), R.row(0).dot(SRt.col(2)), R.row(1).dot(SRt.col(2))};
}

}  // namespace softgauss

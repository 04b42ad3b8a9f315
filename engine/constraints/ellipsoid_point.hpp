// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The place of an ellipsoid that has an outward normal d.
///
/// With its radii H along axes R and W = R H² Rᵀ, the place is  s = W d/q,  q = √(d·W d),  from the
/// centre. As d turns at the rate e against the ellipsoid, the place runs over it at
///   ṡ = (W e − s (s·e))/q
/// which is r e for a sphere of radius r.

#include <cmath>

#include "softgauss/engine/core/types.hpp"

namespace softgauss {

inline Matrix3 ellipsoidTensor(const Matrix3& R, const Vector3& radii) {
  return R * radii.cwiseAbs2().asDiagonal() * R.transpose();
}

/// ṡ; d a unit vector.
inline Vector3 ellipsoidPointRate(const Matrix3& W, const Vector3& d, const Vector3& e) {
  const Vector3 Wd = W * d;
  const double q = std::sqrt(d.dot(Wd));
  const Vector3 s = Wd / q;
  return (W * e - s * s.dot(e)) / q;
}

/// Change of ṡ where W, d and e change.
inline Vector3 ellipsoidPointRateChange(const Matrix3& W, const Matrix3& dW, const Vector3& d,
                                        const Vector3& dd, const Vector3& e, const Vector3& de) {
  const Vector3 Wd = W * d, dWd = dW * d + W * dd;
  const double q = std::sqrt(d.dot(Wd)), dq = (dd.dot(Wd) + d.dot(dWd)) / (2.0 * q);
  const Vector3 s = Wd / q, ds = (dWd - s * dq) / q;
  const Vector3 rate = (W * e - s * s.dot(e)) / q;
  return (dW * e + W * de - ds * s.dot(e) - s * (ds.dot(e) + s.dot(de)) - rate * dq) / q;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// B = V ×* I − I V × + (I V) ×̄* of (2.9), the matrix by which Coriolis and gyroscopic forces of a
/// body change with its velocity; ×̄* is the product ×* as a matrix on its left factor. B of a
/// subtree is the sum over its bodies.

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/core/spatial.hpp"

namespace softgauss {

/// B of one body of inertia I that moves by V.
inline Matrix6 coriolisMatrix(const Inertia& inertia, const Motion& V) {
  const Matrix3 I = inertia.I_O.matrix(), h = skew(inertia.h);
  const Matrix3 w = skew(V.angular), u = skew(V.linear);
  const Force p = inertia * V;
  const Matrix3 k = skew(p.moment), l = skew(p.force);
  Matrix6 B;
  B.topLeftCorner<3, 3>() = w * I - u * h - I * w - h * u - k;
  B.topRightCorner<3, 3>() = w * h + inertia.mass * u - h * w - l;
  B.bottomLeftCorner<3, 3>() = -w * h + h * w - inertia.mass * u - l;
  B.bottomRightCorner<3, 3>().setZero();  // m ω× − m ω×
  return B;
}

/// B S.
inline Force coriolisProduct(const Matrix6& B, const Motion& S) {
  return {B.topLeftCorner<3, 3>() * S.angular + B.topRightCorner<3, 3>() * S.linear,
          B.bottomLeftCorner<3, 3>() * S.angular + B.bottomRightCorner<3, 3>() * S.linear};
}

/// Bᵀ S, as a force: dot(T, ·) is S · B T.
inline Force coriolisTransposedProduct(const Matrix6& B, const Motion& S) {
  return {B.topLeftCorner<3, 3>().transpose() * S.angular +
              B.bottomLeftCorner<3, 3>().transpose() * S.linear,
          B.topRightCorner<3, 3>().transpose() * S.angular +
              B.bottomRightCorner<3, 3>().transpose() * S.linear};
}

/// E of a dof of `body` that moves by V: by δA_b = E_j − V_b × S_j change the accelerations of what
/// the dof moves with its velocity. The axes of a floating body turn with it and pass its origin,
/// which moves.
inline Motion coriolisRate(bool floatingTranslation, bool floatingRotation, const Motion& S,
                           const Motion& V) {
  if (floatingTranslation) return {};
  if (floatingRotation) return {V.angular.cross(S.angular), 2.0 * V.linear.cross(S.angular)};
  return cross(V, S) * 2.0;
}

}  // namespace softgauss

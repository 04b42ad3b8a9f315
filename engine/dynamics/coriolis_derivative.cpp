// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/coriolis_derivative.hpp"

#include "softgauss/engine/core/rotation.hpp"

namespace softgauss {
namespace {

/// B of one body.
Matrix6 bodyMatrix(const Inertia& inertia, const Motion& V) {
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

Force product(const Matrix6& B, const Motion& S) {
  return {B.topLeftCorner<3, 3>() * S.angular + B.topRightCorner<3, 3>() * S.linear,
          B.bottomLeftCorner<3, 3>() * S.angular + B.bottomRightCorner<3, 3>() * S.linear};
}

/// Bᵀ S, as a force: dot(T, ·) is S · B T.
Force transposedProduct(const Matrix6& B, const Motion& S) {
  return {B.topLeftCorner<3, 3>().transpose() * S.angular +
              B.bottomLeftCorner<3, 3>().transpose() * S.linear,
          B.topRightCorner<3, 3>().transpose() * S.angular +
              B.bottomRightCorner<3, 3>().transpose() * S.linear};
}

/// E of a dof. The axes of a floating body turn with it and pass its origin, which moves.
Motion ownRate(const Body& body, int dof, const Motion& S, const Motion& V) {
  if (body.joint != JointKind::floating) return cross(V, S) * 2.0;
  if (dof - body.v < 3) return {};
  return {V.angular.cross(S.angular), 2.0 * V.linear.cross(S.angular)};
}

}  // namespace

void CoriolisDerivative::addTo(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                               double scale, TreePair& A) {
  for (int b = 1; b < model.bodyCount(); ++b) {
    if (model.bodies[b].massless)
      B_[b].setZero();
    else
      B_[b] = bodyMatrix(inertia.body[b], k.V[b]);
  }
  for (int b = model.bodyCount() - 1; b > 0; --b)
    if (model.bodies[b].parent != 0) B_[model.bodies[b].parent] += B_[b];

  A.lower.resize(inertia.sparsity);
  A.upper.resize(inertia.sparsity);
  for (int i = 0; i < model.nv; ++i) {
    const int b = model.dofs[i].body;
    const Motion& S = k.S[i];
    E_[i] = ownRate(model.bodies[b], i, S, k.V[b]);
    P_[i] = inertia.composite[b] * E_[i] + product(B_[b], S);
    const Force IS = inertia.composite[b] * S, BS = transposedProduct(B_[b], S);
    const double* M = inertia.M.row(i);
    double* lower = A.lower.row(i);
    double* upper = A.upper.row(i);
    for (int j = i; j >= 0; j = model.dofs[j].parent) {
      lower[j] = M[j] + scale * (dot(E_[j], IS) + dot(k.S[j], BS));
      upper[j] = M[j] + scale * dot(k.S[j], P_[i]);
    }
  }
}

}  // namespace softgauss

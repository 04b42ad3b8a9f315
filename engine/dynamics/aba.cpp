// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/aba.hpp"

#include <Eigen/Cholesky>

#include "softgauss/engine/core/spatial_matrix.hpp"

namespace softgauss {
namespace {

using Matrix6X = Eigen::Matrix<double, 6, Eigen::Dynamic>;

}  // namespace

VectorX articulatedBodyAcceleration(const Model& model, const Kinematics& k,
                                    const MassMatrix& inertia, const VectorX& tau) {
  const int bodies = model.bodyCount();
  const bool coriolis = model.options.effects.has(Effect::coriolis);
  const bool armature = model.options.effects.has(Effect::armature);
  std::vector<Matrix6> IA(bodies, Matrix6::Zero());
  std::vector<Vector6> pA(bodies, Vector6::Zero()), A(bodies, Vector6::Zero());
  std::vector<Matrix6X> S(bodies), U(bodies);
  std::vector<MatrixX> Dinv(bodies);
  std::vector<VectorX> u(bodies);

  for (int b = 1; b < bodies; ++b) {
    const Body& body = model.bodies[b];
    S[b].resize(6, body.dofs);
    for (int i = 0; i < body.dofs; ++i) S[b].col(i) = stacked(k.S[body.v + i]);
    if (body.massless) continue;
    IA[b] = spatialMatrix(inertia.body[b]);
    if (coriolis) pA[b] = stacked(crossForce(k.V[b], inertia.body[b] * k.V[b]));
  }
  // Velocity-product acceleration of joint b alone.
  const auto c = [&](int b) {
    return coriolis ? Vector6(stacked(k.A_bias[b] - k.A_bias[model.bodies[b].parent]))
                    : Vector6::Zero();
  };
  for (int b = bodies - 1; b > 0; --b) {
    const Body& body = model.bodies[b];
    U[b] = IA[b] * S[b];
    MatrixX D = S[b].transpose() * U[b];
    if (armature)
      for (int i = 0; i < body.dofs; ++i) D(i, i) += model.dofs[body.v + i].armature;
    Dinv[b] = D.llt().solve(MatrixX::Identity(body.dofs, body.dofs));
    u[b] = tau.segment(body.v, body.dofs) - S[b].transpose() * pA[b];
    if (body.parent == 0) continue;
    const Matrix6 Ia = IA[b] - U[b] * Dinv[b] * U[b].transpose();
    IA[body.parent] += Ia;
    pA[body.parent] += pA[b] + Ia * c(b) + U[b] * (Dinv[b] * u[b]);
  }
  if (model.options.effects.has(Effect::gravity)) A[0].tail<3>() = -model.options.gravity;
  VectorX vdot(model.nv);
  for (int b = 1; b < bodies; ++b) {
    const Body& body = model.bodies[b];
    const Vector6 A0 = A[body.parent] + c(b);
    vdot.segment(body.v, body.dofs) = Dinv[b] * (u[b] - U[b].transpose() * A0);
    A[b] = A0 + S[b] * vdot.segment(body.v, body.dofs);
  }
  return vdot;
}

}  // namespace softgauss

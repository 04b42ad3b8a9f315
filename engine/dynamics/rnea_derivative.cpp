// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/rnea_derivative.hpp"

#include "softgauss/engine/dynamics/motion_derivative.hpp"

namespace softgauss {

RneaDerivative::RneaDerivative(const Model& model)
    : v_(VectorX::Zero(model.nv)),
      B_(model.bodies.size()),
      V_(model.bodies.size()),
      A_(model.bodies.size()),
      F_(model.bodies.size()),
      c_(model.dofs.size()),
      d_(model.dofs.size()),
      E_(model.dofs.size()) {}

void RneaDerivative::sweep(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                           const VectorX& a) {
  const bool coriolis = model.options.effects.has(Effect::coriolis);
  A_[0] = {};
  if (model.options.effects.has(Effect::gravity)) A_[0].linear = -model.options.gravity;
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    V_[b] = coriolis ? k.midstepVelocities()[b] : Motion{};
    if (body.joint == JointKind::floating) v_.segment<3>(body.v) = V_[b].linear;
    // Without the bias part, which the kinematics hold.
    A_[b] = A_[body.parent];
    for (int i = body.v; i < body.v + body.dofs; ++i) A_[b] += k.S[i] * a[i];
  }
  for (int b = 1; b < model.bodyCount(); ++b) {
    if (coriolis) A_[b] += k.A_bias[b];
    B_[b].setZero();
    F_[b] = {};
    if (model.bodies[b].massless) continue;
    const Inertia& I = inertia.body[b];
    F_[b] = I * A_[b] + crossForce(V_[b], I * V_[b]);
    if (coriolis) B_[b] = coriolisMatrix(I, V_[b]);
  }
  for (int b = model.bodyCount() - 1; b > 0; --b) {
    const int parent = model.bodies[b].parent;
    if (parent == 0) continue;
    F_[parent] += F_[b];
    B_[parent] += B_[b];
  }
}

void RneaDerivative::addTo(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                           const VectorX& a, MatrixX& Gq, MatrixX& Gv) {
  sweep(model, k, inertia, a);
  for (int i = 0; i < model.nv; ++i) {
    const int b = model.dofs[i].body;
    const Body& body = model.bodies[b];
    const Motion& S = k.S[i];
    const bool floats = body.joint == JointKind::floating, translates = floats && i - body.v < 3;
    const Motion against = motionAgainst(model, i, V_, {}, v_);
    d_[i] = cross(against, S);
    c_[i] = cross(motionAgainst(model, i, A_, A_[0], a), S) + cross(against, d_[i]);
    E_[i] = coriolisRate(translates, floats && !translates, S, V_[b]);

    const Inertia& I = inertia.composite[b];
    const Force T = I * c_[i] + coriolisProduct(B_[b], d_[i]), R = T + crossForce(S, F_[b]),
                P = I * E_[i] + coriolisProduct(B_[b], S), IS = I * S,
                BS = coriolisTransposedProduct(B_[b], S);
    for (int j = i; j >= 0; j = model.dofs[j].parent) {
      Gq(i, j) += dot(c_[j], IS) + dot(d_[j], BS);
      Gv(i, j) += dot(E_[j], IS) + dot(k.S[j], BS);
      if (j == i) continue;
      Gq(j, i) += dot(k.S[j], areRotationsOfOneJoint(model, i, j) ? T : R);
      Gv(j, i) += dot(k.S[j], P);
    }
  }
}

}  // namespace softgauss

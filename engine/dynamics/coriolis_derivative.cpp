// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/coriolis_derivative.hpp"

#include "softgauss/engine/dynamics/coriolis_matrix.hpp"

namespace softgauss {

void CoriolisDerivative::addTo(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                               double scale, TreePair& A) {
  for (int b = 1; b < model.bodyCount(); ++b) {
    if (model.bodies[b].massless)
      B_[b].setZero();
    else
      B_[b] = coriolisMatrix(inertia.body[b], k.V[b]);
  }
  for (int b = model.bodyCount() - 1; b > 0; --b)
    if (model.bodies[b].parent != 0) B_[model.bodies[b].parent] += B_[b];

  A.lower.resize(inertia.sparsity);
  A.upper.resize(inertia.sparsity);
  for (int i = 0; i < model.nv; ++i) {
    const int b = model.dofs[i].body;
    const Motion& S = k.S[i];
    const bool floats = model.bodies[b].joint == JointKind::floating;
    const bool translates = floats && i - model.bodies[b].v < 3;
    E_[i] = coriolisRate(translates, floats && !translates, S, k.V[b]);
    P_[i] = inertia.composite[b] * E_[i] + coriolisProduct(B_[b], S);
    const Force IS = inertia.composite[b] * S, BS = coriolisTransposedProduct(B_[b], S);
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

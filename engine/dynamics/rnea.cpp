// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/rnea.hpp"

namespace softgauss {
namespace {

/// Force that moves body b with acceleration A against gravity g:  I (A − g) + V ×* I V.
Force bodyForce(const Inertia& I, const Motion& V, Motion A, const Vector3& g, bool coriolis) {
  A.linear -= g;
  Force F = I * A;
  if (coriolis) F += crossForce(V, I * V);
  return F;
}

/// Adds the forces of the subtrees up to the root and projects them on the joints.
void project(const Model& model, const Kinematics& k, Segments bodies, RneaWorkspace& work,
             VectorX& tau) {
  for (const Segment s : bodies)
    for (int b = s.end - 1; b >= s.begin; --b) {
      const Body& body = model.bodies[b];
      const Force& F = work.F[b];
      for (int i = body.v; i < body.v + body.dofs; ++i) tau[i] = dot(k.S[i], F);
      if (body.parent != 0) work.F[body.parent] += F;
    }
}

Vector3 gravityOf(const Model& model) {
  return model.options.effects.has(Effect::gravity) ? model.options.gravity : Vector3::Zero();
}

void biasFrom(const Model& model, const Kinematics& k, const std::vector<Motion>& V,
              const std::vector<Motion>& A_bias, const MassMatrix& inertia, Segments bodies,
              RneaWorkspace& work, VectorX& bias) {
  const Vector3 g = gravityOf(model);
  const bool coriolis = model.options.effects.has(Effect::coriolis);
  for (const Segment s : bodies)
    for (int b = s.begin; b < s.end; ++b)
      work.F[b] =
          model.bodies[b].massless
              ? Force{}
              : bodyForce(inertia.body[b], V[b], coriolis ? A_bias[b] : Motion{}, g, coriolis);
  project(model, k, bodies, work, bias);
}

}  // namespace

void computeBias(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                 Segments bodies, RneaWorkspace& work, VectorX& bias) {
  biasFrom(model, k, k.midstepVelocities(), k.A_bias, inertia, bodies, work, bias);
}

void computeBiasAt(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                   const VectorX& v, Segments bodies, RneaWorkspace& work, VectorX& bias) {
  computeVelocities(model, k, v, bodies, work.V, work.A);
  biasFrom(model, k, work.V, work.A, inertia, bodies, work, bias);
}

void inverseDynamicsTree(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                         const VectorX& vdot, RneaWorkspace& work, VectorX& tau) {
  const Vector3 g = gravityOf(model);
  const bool coriolis = model.options.effects.has(Effect::coriolis);
  const std::vector<Motion>& V = k.midstepVelocities();
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[b];
    // Acceleration without the bias part, which the kinematics already hold.
    Motion& A = work.A[b];
    A = body.parent == 0 ? Motion{} : work.A[body.parent];
    for (int i = body.v; i < body.v + body.dofs; ++i) A += k.S[i] * vdot[i];
    work.F[b] = body.massless
                    ? Force{}
                    : bodyForce(inertia.body[b], V[b], coriolis ? A + k.A_bias[b] : A, g, coriolis);
  }
  const Segment all = allBodies(model);
  project(model, k, {&all, 1}, work, tau);
  if (model.options.effects.has(Effect::armature))
    for (int i = 0; i < model.nv; ++i) tau[i] += model.dofs[i].armature * vdot[i];
}

}  // namespace softgauss

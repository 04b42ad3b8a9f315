// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/body_motion.hpp"

#include "softgauss/engine/core/six_vectors.hpp"

namespace softgauss {

namespace {

void moveBody(const Model& model, const Kinematics& k, int b, const VectorX& a,
              std::vector<Motion>& A) {
  const Body& body = model.bodies[idx(b)];
  Motion V = A[idx(body.parent)];
  for (int i = body.v; i < body.v + body.dofs; ++i) addSix(a[i], numbers(k.S[idx(i)]), numbers(V));
  A[idx(b)] = V;
}

}  // namespace

void moveBodies(const Model& model, const Kinematics& k, Segments bodies, const VectorX& a,
                std::vector<Motion>& A) {
  for (const Segment s : bodies)
    for (int b = s.begin; b < s.end; ++b) moveBody(model, k, b, a, A);
}

double twiceKineticEnergy(const Model& model, const Tree& tree, const Kinematics& k,
                          const MassMatrix& inertia, const VectorX& x, std::vector<Motion>& V) {
  double sum = 0.0;
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
    moveBody(model, k, b, x, V);
    if (!model.bodies[idx(b)].massless) sum += dot(V[idx(b)], inertia.body[idx(b)] * V[idx(b)]);
  }
  if (model.options.effects.has(Effect::armature))
    for (int i = tree.firstDof; i < tree.dofEnd; ++i)
      sum += model.dofs[idx(i)].armature * x[i] * x[i];
  return sum;
}

void addBodyForces(const Model& model, const Kinematics& k, Segments bodies, std::vector<Force>& F,
                   VectorX& tau) {
  for (const Segment s : bodies)
    for (int b = s.end - 1; b >= s.begin; --b) {
      const Body& body = model.bodies[idx(b)];
      const double* force = numbers(F[idx(b)]);
      for (int i = body.v; i < body.v + body.dofs; ++i)
        tau[i] += dotSix(numbers(k.S[idx(i)]), force);
      if (body.parent != 0) F[idx(body.parent)] += F[idx(b)];
    }
}

void multiplyInertias(const Model& model, const MassMatrix& inertia, Segments bodies,
                      const std::vector<Motion>& A, std::vector<Force>& IA) {
  for (const Segment s : bodies)
    for (int b = s.begin; b < s.end; ++b)
      IA[idx(b)] = model.bodies[idx(b)].massless ? Force{} : inertia.body[idx(b)] * A[idx(b)];
}

}  // namespace softgauss

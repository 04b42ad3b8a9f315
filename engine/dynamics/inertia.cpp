// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/inertia.hpp"

#include <cmath>

#include "softgauss/engine/core/check.hpp"

namespace softgauss {

MassMatrix::MassMatrix(const Model& model)
    : body(model.bodies.size()), composite(model.bodies.size()), sparsity(model) {
  M.resize(sparsity);
  M.setZero();
  Mhat.resize(sparsity);
  forceScale = motionScale = added = VectorX::Zero(model.nv);
}

void computeMassMatrix(const Model& model, const Kinematics& k, MassMatrix& stage, bool whole) {
  const int bodies = model.bodyCount();

  // Inertia of each body in the coordinates of its tree.
  for (int b = 1; b < bodies; ++b) {
    const Body& body = model.bodies[b];
    if (!body.massless) {
      const Transform& X = k.X_WB[b];
      const Vector3 c = X.R * body.com + (X.p - k.p_WO[body.tree]);
      stage.body[b] = Inertia::fromCentral(body.mass, c, rotated(X.R, body.I_Bcm));
    }
    stage.composite[b] = stage.body[b];
  }
  for (int b = bodies - 1; b > 0; --b)
    if (model.bodies[b].parent != 0) stage.composite[model.bodies[b].parent] += stage.composite[b];

  const bool armature = model.options.effects.has(Effect::armature);
  for (int i = model.nv - 1; i >= 0; --i) {
    const Dof& dof = model.dofs[i];
    const Force F = stage.composite[dof.body] * k.S[i];
    double* row = stage.M.row(i);
    for (const Segment* s = stage.sparsity.begin(i);
         (whole || kChecked) && s != stage.sparsity.end(i); ++s)
      for (int j = s->begin; j < s->end; ++j) row[j] = whole ? dot(k.S[j], F) : kNaN;
    row[i] = dot(k.S[i], F);
    if (armature) row[i] += dof.armature;
    stage.motionScale[i] = 1.0 / std::sqrt(row[i]);
  }
  stage.forceScale = stage.motionScale;
  stage.whole = whole;
  stage.added.setZero();
  stage.anyAdded = false;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/inertia.hpp"

#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/segment_vectors.hpp"

namespace softgauss {

MassMatrix::MassMatrix(const Model& model)
    : body(model.bodies.size()), composite(model.bodies.size()), sparsity(model) {
  M.resize(sparsity);
  M.setZero();
  Mhat.resize(sparsity);
  forceScale = motionScale = added = VectorX::Zero(model.nv);
}

namespace {

/// Inertias of these bodies in the coordinates of their trees, and of their subtrees.
void findInertias(const Model& model, const Kinematics& k, Segment bodies, MassMatrix& stage) {
  for (int b = bodies.begin; b < bodies.end; ++b) {
    const Body& body = model.bodies[b];
    if (!body.massless) {
      const Transform& X = k.X_WB[b];
      const Vector3 c = X.R * body.com + (X.p - k.p_WO[body.tree]);
      stage.body[b] = Inertia::fromCentral(body.mass, c, rotated(X.R, body.I_Bcm));
    }
    stage.composite[b] = stage.body[b];
  }
  for (int b = bodies.end - 1; b >= bodies.begin; --b)
    if (model.bodies[b].parent != 0) stage.composite[model.bodies[b].parent] += stage.composite[b];
}

/// Row i of M.
void findRow(const Model& model, const Kinematics& k, int i, bool whole, MassMatrix& stage) {
  const Dof& dof = model.dofs[i];
  const Force F = stage.composite[dof.body] * k.S[i];
  double* row = stage.M.row(i);
  for (const Segment* s = stage.sparsity.begin(i);
       (whole || kChecked) && s != stage.sparsity.end(i); ++s)
    for (int j = s->begin; j < s->end; ++j) row[j] = whole ? dot(k.S[j], F) : kNaN;
  row[i] = dot(k.S[i], F);
  if (model.options.effects.has(Effect::armature)) row[i] += dof.armature;
  stage.motionScale[i] = 1.0 / std::sqrt(row[i]);
}

}  // namespace

void computeMassMatrix(const Model& model, const Kinematics& k, MassMatrix& stage, bool whole) {
  const Segment bodies = allBodies(model), dofs{0, model.nv};
  computeMassMatrix(model, k, {&bodies, 1}, {&dofs, 1}, stage, whole);
}

void computeMassMatrix(const Model& model, const Kinematics& k, Segments bodies, Segments dofs,
                       MassMatrix& stage, bool whole) {
  for (const Segment s : bodies) findInertias(model, k, s, stage);
  for (const Segment s : dofs)
    for (int i = s.begin; i < s.end; ++i) findRow(model, k, i, whole, stage);
  copy(dofs, stage.motionScale, stage.forceScale);
  stage.whole = whole;
  setZero(dofs, stage.added);
  stage.anyAdded = false;
}

}  // namespace softgauss

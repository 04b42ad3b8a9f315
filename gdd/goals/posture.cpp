// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/goals/posture.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/dynamics/jacobian.hpp"

namespace softgauss::gdd {
namespace {

constexpr double kLeft = 1e-4;  // ε of (9.24)

/// extra (nv): what is added to the inertia of floating bases whose robot touches something.
void addHeldBases(const GoalContext& context, VectorX& extra) {
  const double times = 1.0 / std::sqrt(kLeft) - 1.0;
  const Model& model = context.model;
  extra.setZero();
  for (const Contact& contact : context.data.contacts.contacts)
    for (const int geometry : {contact.geometryA, contact.geometryB}) {
      const int tree = model.bodies[model.geometries[geometry].body].tree;
      if (tree < 0 || !model.floats(tree)) continue;
      const Body& root = model.bodies[model.trees[tree].rootBody];
      for (int i = root.v; i < root.v + root.dofs; ++i)
        extra[i] = times * context.data.inertia.M.row(i)[i];
    }
}

}  // namespace

/// Jᵀ of the places that act now, the first columns of work.placeRows; returns how many.
Eigen::Index Posture::findRows(const GoalContext& context, GoalWorkspace& work) const {
  const Model& model = context.model;
  const Kinematics& k = context.data.kinematics;
  Eigen::Index used = 0;
  work.placeRows.resize(model.nv, static_cast<Eigen::Index>(6 * yieldsTo.size()));
  for (const LedPlace& place : yieldsTo) {
    const int body = model.frames[place.frame].body;
    if (!(place.startTime <= context.state.time && context.state.time < place.endTime)) continue;
    if (model.bodies[body].dofs == 0) continue;  // fixed to the world
    pointJacobian(model, k, body, framePose(model, k, place.frame) * place.p_FP,
                  work.J.topRows<3>());
    if (place.turns) rotationJacobian(model, k, body, work.J.bottomRows<3>());
    const Eigen::Index rows = place.turns ? 6 : 3;
    work.placeRows.middleCols(used, rows) = work.J.topRows(rows).transpose();
    used += rows;
  }
  return used;
}

/// pull ← N pull.
void Posture::yield(const GoalContext& context, GoalWorkspace& work, VectorX& pull) const {
  const Model& model = context.model;
  const Eigen::Index used = findRows(context, work);
  TreeFactor& factor = work.massFactor;
  addHeldBases(context, work.dofs);
  if (used == 0 || !factor.compute(context.data.inertia.M, work.dofs.data()))
    return;  // the solver reports it
  const MatrixX& Jt = work.placeRows;
  // C = Σ over dofs of h hᵀ/D, h the rows of L⁻ᵀJᵀ, M = LᵀDL.
  work.placePull.resize(used);
  work.placeInertia.resize(used, used);
  VectorX& x = work.dofs;
  MatrixX& half = work.placeHalf;
  half.resize(model.nv, used);
  for (Eigen::Index i = 0; i < used; ++i) {
    work.placePull[i] = Jt.col(i).dot(pull);
    x = Jt.col(i);
    factor.solveTransposed(x);
    for (int dof = 0; dof < model.nv; ++dof)
      half(dof, i) = x[dof] * std::sqrt(factor.inversePivot(dof));
  }
  MatrixX& C = work.placeInertia;
  for (Eigen::Index i = 0; i < used; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) C(i, j) = half.col(i).dot(half.col(j));
  for (Eigen::Index i = 0; i < used; ++i) {
    C(i, i) *= 1.0 + kLeft;
    if (!(C(i, i) > 0.0)) C(i, i) = 1.0;  // nothing moves along this row
  }
  work.placeFactor.compute(C);
  if (work.placeFactor.info() != Eigen::Success) return;
  work.placeFactor.solveInPlace(work.placePull);
  x.setZero();
  for (Eigen::Index i = 0; i < used; ++i) x += work.placePull[i] * Jt.col(i);
  factor.solve(x);
  pull -= work.placeShare * x;
}

/// q* ⊖ q (nv).
void Posture::findAway(const GoalContext& context, VectorX& away) const {
  positionDifference(context.model, context.state.q, q, away);
  for (const JointTarget& target : moving) {
    const Body& body = context.model.bodies[target.body];
    away[body.v] = target.positionAt(context.state.time).p - context.state.q[body.q];
  }
}

void Posture::addCost(const GoalContext& context, GoalCost& cost) const {
  VectorX& pull = cost.workspace().pull;
  findAway(context, pull);
  pull *= stiffness;
  for (const JointTarget& target : moving) {
    const CoordinateMotion to = target.positionAt(context.state.time);
    pull[context.model.bodies[target.body].v] += to.a + damping * to.v;
  }
  if (!yieldsTo.empty()) yield(context, cost.workspace(), pull);
  cost.addMetric(weight, context.data.inertia.M, pull - damping * context.state.v);
}

bool Posture::steadyAt(double time) const {
  return std::none_of(moving.begin(), moving.end(),
                      [&](const JointTarget& target) { return target.movesAt(time); });
}

}  // namespace softgauss::gdd

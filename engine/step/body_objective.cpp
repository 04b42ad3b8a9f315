// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/body_objective.hpp"

#include <algorithm>

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/core/six_vectors.hpp"
#include "softgauss/engine/step/data.hpp"

namespace softgauss {
namespace {

/// Σ A_bᵀ F_b.
double power(Segments bodies, const std::vector<Motion>& A, const std::vector<Force>& F) {
  double sum = 0.0;
  for (const Segment s : bodies)
    for (std::size_t b = idx(s.begin); b < idx(s.end); ++b)
      sum += dotSix(numbers(A[b]), numbers(F[b]));
  return sum;
}

}  // namespace

BodySolution::BodySolution(const Model& model)
    : massFactor(model),
      factor(model),
      A(model.bodies.size()),
      ray(model.bodies.size()),
      IA(model.bodies.size()),
      Iray(model.bodies.size()),
      force(model.bodies.size()),
      diagonal(VectorX::Zero(model.nv)),
      divided(diagonal),
      islands(model) {
  factor.couple(pairs, islands);
}

void BodySolution::findDiagonal(const Model& model, const MassMatrix& inertia, Segments dofs) {
  copy(dofs, inertia.added, diagonal);
  if (!model.options.effects.has(Effect::armature)) return;
  for (const Segment s : dofs)
    for (int i = s.begin; i < s.end; ++i) diagonal[i] += model.dofs[idx(i)].armature;
}

void BodySolution::divide(const Model& model, const MassMatrix& inertia, const TreeSelection& trees,
                          Constraints& rows) {
  findDiagonal(model, inertia, trees.dofs());
  pairs.clear();
  rows.appendPairs(pairs);
  const std::size_t ofBodies = pairs.size();
  pairs.emplace_back(0, 0);  // where those that rows couple end: the world couples nothing
  rows.appendCoupledBodies(model, pairs);
  pairs.insert(pairs.end(), tied.begin(), tied.end());
  if (pairs != lastPairs || trees.still() != lastStill) {
    lastPairs = pairs;
    lastStill = trees.still();
    islands.find(model, pairs, trees.still());
    pairs.resize(ofBodies);
    factor.couple(pairs, islands);
  }
  if (model.trees.size() > 1) rows.divide(model, islands);
}

void BodySolution::multiplyMass(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                                const VectorX& x, VectorX& y) {
  const Segment all = allBodies(model), dofs{0, model.nv};
  findDiagonal(model, inertia, {&dofs, 1});
  moveBodies(model, k, x, ray);
  multiplyInertias(model, inertia, {&all, 1}, ray, force);
  y = diagonal.cwiseProduct(x);
  addBodyForces(model, k, force, y);
}

void BodySolution::moveTo(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                          Segments bodies, const VectorX& a) {
  moveBodies(model, k, bodies, a, A);
  multiplyInertias(model, inertia, bodies, A, IA);
}

void BodySolution::moveTo(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                          const VectorX& a) {
  const Segment all = allBodies(model), dofs{0, model.nv};
  findDiagonal(model, inertia, {&dofs, 1});
  moveTo(model, k, inertia, {&all, 1}, a);
}

void BodySolution::addForces(const Model& model, const Kinematics& k, const Constraints& rows,
                             Segments bodies, Segments dofs, const VectorX& a, VectorX& tau) {
  for (const Segment s : dofs) part(tau, s) -= part(diagonal, s).cwiseProduct(part(a, s));
  for (const Segment s : bodies)
    for (std::size_t b = idx(s.begin); b < idx(s.end); ++b) force[b] = Force{} - IA[b];
  BodyForce all{tau, force};
  rows.addForce(all);
  addBodyForces(model, k, bodies, force, tau);
}

void BodySolution::addForces(const Model& model, const Kinematics& k, const Constraints& rows,
                             const VectorX& a, VectorX& tau) {
  const Segment bodies = allBodies(model), dofs{0, model.nv};
  addForces(model, k, rows, {&bodies, 1}, {&dofs, 1}, a, tau);
}

double setForceScale(Segments dofs, Data& data) {
  const VectorX& unit = data.inertia.forceScale;
  const double most = std::max(1.0, largest(dofs, data.forces.net, unit));
  for (const Segment s : dofs) part(data.forward.scale, s) = part(unit, s) / most;
  return most;
}

BodyObjective::BodyObjective(const Model& model, Data& data, int island)
    : model_(model),
      data_(data),
      island_(island),
      bodies_(data.bodies.islands.bodies(island)),
      dofs_(data.bodies.islands.dofs(island)),
      rows_(data.constraints),
      s_(data.bodies) {
  unit_ = setForceScale(dofs_, data);
  if (model.trees.size() > 1) rows_.select(island);
}

double BodyObjective::moveTo(const VectorX& at) {
  VectorX& a = data_.forward.a;
  copy(dofs_, at, a);
  s_.moveTo(model_, data_.kinematics, data_.inertia, bodies_, a);
  rows_.setResidual(BodyMotion{a, s_.A});
  const double cost = rows_.evaluate(changed_);
  fresh_ = true;
  return 0.5 * (power(bodies_, s_.A, s_.IA) + dot(dofs_, a, s_.diagonal, a)) -
         dot(dofs_, a, data_.forces.net) + cost;
}

double BodyObjective::gradient(VectorX& g) {
  if (!fresh_) rows_.evaluate(changed_);
  fresh_ = false;
  // −g = τ − c − M a + Jᵀf
  copy(dofs_, data_.forces.net, g);
  s_.addForces(model_, data_.kinematics, rows_, bodies_, dofs_, data_.forward.a, g);
  for (const Segment s : dofs_) part(g, s) = -part(g, s);
  return largest(dofs_, g, data_.forward.scale);
}

bool BodyObjective::factorize() {
  changed_ = false;
  newFactor_ = true;
  s_.factor.begin(model_, data_.inertia, s_.islands, island_);
  rows_.addCurvature(s_.factor);
  return s_.factor.factor(model_, data_.kinematics);
}

double BodyObjective::direction(const VectorX& g, VectorX& d) {
  for (const Segment s : dofs_) part(d, s) = -part(g, s);
  s_.factor.solve(model_, data_.kinematics, d, s_.ray);
  multiplyInertias(model_, data_.inertia, bodies_, s_.ray, s_.Iray);
  rows_.setRay(BodyMotion{d, s_.ray});
  // Along the ray the smooth part has slope dᵀ(M a − net) + α dᵀM d.
  slope_ = power(bodies_, s_.ray, s_.IA) + dot(dofs_, d, s_.diagonal, data_.forward.a) -
           dot(dofs_, d, data_.forces.net);
  curvature_ = power(bodies_, s_.ray, s_.Iray) + dot(dofs_, d, s_.diagonal, d);
  return dot(dofs_, g, d);
}

Jet BodyObjective::along(double alpha) const {
  Jet jet{0.0, slope_ + alpha * curvature_, curvature_};
  rows_.along(alpha, jet);
  return jet;
}

void BodyObjective::advance(const VectorX& d, double alpha) {
  for (const Segment s : dofs_) part(data_.forward.a, s) += alpha * part(d, s);
  for (const Segment s : bodies_)
    for (std::size_t b = idx(s.begin); b < idx(s.end); ++b) {
      addSix(alpha, numbers(s_.ray[b]), numbers(s_.A[b]));
      addSix(alpha, numbers(s_.Iray[b]), numbers(s_.IA[b]));
    }
  rows_.advance(alpha);
  newFactor_ = false;
}

static_assert(NewtonObjective<BodyObjective>);

}  // namespace softgauss

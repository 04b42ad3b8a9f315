// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/body_objective.hpp"

#include <algorithm>

#include "softgauss/engine/core/six_vectors.hpp"
#include "softgauss/engine/step/data.hpp"

namespace softgauss {
namespace {

/// Σ A_bᵀ F_b.
double power(const std::vector<Motion>& A, const std::vector<Force>& F) {
  double sum = 0.0;
  for (std::size_t b = 1; b < A.size(); ++b) sum += dotSix(numbers(A[b]), numbers(F[b]));
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
      diagonal(VectorX::Zero(model.nv)) {}

void BodySolution::findDiagonal(const Model& model, const MassMatrix& inertia) {
  diagonal = inertia.added;
  if (model.options.effects.has(Effect::armature))
    for (int i = 0; i < model.nv; ++i) diagonal[i] += model.dofs[idx(i)].armature;
}

void BodySolution::multiplyMass(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                                const VectorX& x, VectorX& y) {
  findDiagonal(model, inertia);
  moveBodies(model, k, x, ray);
  multiplyInertias(model, inertia, ray, force);
  y = diagonal.cwiseProduct(x);
  addBodyForces(model, k, force, y);
}

void BodySolution::moveTo(const Model& model, const Kinematics& k, const MassMatrix& inertia,
                          const VectorX& a) {
  findDiagonal(model, inertia);
  moveBodies(model, k, a, A);
  multiplyInertias(model, inertia, A, IA);
}

void BodySolution::addForces(const Model& model, const Kinematics& k, const Constraints& rows,
                             const VectorX& a, VectorX& tau) {
  tau -= diagonal.cwiseProduct(a);
  for (std::size_t b = 1; b < force.size(); ++b) force[b] = Force{} - IA[b];
  BodyForce all{tau, force};
  rows.addForce(all);
  addBodyForces(model, k, force, tau);
}

void setForceScale(Data& data) {
  VectorX& scale = data.forward.scale;
  scale = data.inertia.forceScale;
  scale /= std::max(1.0, data.forces.net.cwiseProduct(scale).cwiseAbs().maxCoeff());
}

BodyObjective::BodyObjective(const Model& model, Data& data)
    : model_(model), data_(data), rows_(data.constraints), s_(data.bodies) {
  setForceScale(data);
  s_.pairs.clear();
  rows_.appendPairs(s_.pairs);
  s_.factor.couple(s_.pairs);
}

double BodyObjective::moveTo(const VectorX& at) {
  VectorX& a = data_.forward.a;
  a = at;
  s_.moveTo(model_, data_.kinematics, data_.inertia, a);
  rows_.setResidual(BodyMotion{a, s_.A});
  const double cost = rows_.evaluate(changed_);
  fresh_ = true;
  return 0.5 * (power(s_.A, s_.IA) + a.dot(s_.diagonal.cwiseProduct(a))) - a.dot(data_.forces.net) +
         cost;
}

double BodyObjective::gradient(VectorX& g) {
  if (!fresh_) rows_.evaluate(changed_);
  fresh_ = false;
  // −g = τ − c − M a + Jᵀf
  g = data_.forces.net;
  s_.addForces(model_, data_.kinematics, rows_, data_.forward.a, g);
  g = -g;
  return g.cwiseProduct(data_.forward.scale).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
}

bool BodyObjective::factorize() {
  changed_ = false;
  newFactor_ = true;
  s_.factor.begin(model_, data_.inertia);
  rows_.addCurvature(s_.factor);
  return s_.factor.factor(model_, data_.kinematics);
}

void BodyObjective::direction(const VectorX& g, VectorX& d) {
  d = -g;
  s_.factor.solve(model_, data_.kinematics, d, s_.ray);
  multiplyInertias(model_, data_.inertia, s_.ray, s_.Iray);
  rows_.setRay(BodyMotion{d, s_.ray});
  // Along the ray the smooth part has slope dᵀ(M a − net) + α dᵀM d.
  slope_ = power(s_.ray, s_.IA) + d.dot(s_.diagonal.cwiseProduct(data_.forward.a)) -
           d.dot(data_.forces.net);
  curvature_ = power(s_.ray, s_.Iray) + d.dot(s_.diagonal.cwiseProduct(d));
}

Jet BodyObjective::along(double alpha) const {
  Jet jet{0.0, slope_ + alpha * curvature_, curvature_};
  rows_.along(alpha, jet);
  return jet;
}

void BodyObjective::advance(const VectorX& d, double alpha) {
  data_.forward.a += alpha * d;
  for (std::size_t b = 1; b < s_.A.size(); ++b) {
    addSix(alpha, numbers(s_.ray[b]), numbers(s_.A[b]));
    addSix(alpha, numbers(s_.Iray[b]), numbers(s_.IA[b]));
  }
  rows_.advance(alpha);
  newFactor_ = false;
}

static_assert(NewtonObjective<BodyObjective>);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/plan_dynamics.hpp"

#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/inverse.hpp"
#include "softgauss/engine/step/step.hpp"

namespace softgauss::planning {

Knot::Knot(const Model& model, const Transition& step)
    : q(model.q0),
      v(VectorX::Zero(model.nv)),
      a(v),
      tau(v),
      G(MatrixX::Zero(model.nv, 2 * model.nv)),
      P(MatrixX::Zero(model.nv, model.nv)),
      transition(step) {}

PlanDynamics::PlanDynamics(const Model& m, ContactSource* contacts)
    : model(m), data(m), middle(m), contacts_(contacts), step_(data, m), derivative_(m) {
  input_.tau = VectorX::Zero(m.nv);
  input_.controlled = allTrees(m);
}

SolveStatus PlanDynamics::stages(const VectorX& q, const VectorX& v) {
  middle.q = q;
  middle.v = v;
  middle.forgetLastStep();
  step_.toMiddle(model, v, middle.q);
  return computeStages(model, input_, middle, data, contacts_);
}

SolveStatus PlanDynamics::inverse(Knot& knot) {
  const SolveStatus status = stages(knot.q, knot.v);
  return isRefused(status) ? status : inverseDynamics(model, knot.a, data, knot.tau);
}

SolveStatus PlanDynamics::linearise(Knot& knot) {
  SolveStatus status = stages(knot.q, knot.v);
  if (!isRefused(status))
    status = derivative_.compute(model, input_, middle, knot.a, contacts_, data);
  if (isRefused(status)) return status;
  knot.tau = derivative_.force();
  const int n = model.nv;
  knot.G.leftCols(n) = derivative_.q();
  knot.G.rightCols(n) = derivative_.v();
  knot.transition.set(knot.v, knot.a);
  auto byPosition = knot.G.leftCols(n), byVelocity = knot.G.rightCols(n);
  knot.transition.fromMiddle(byPosition, byVelocity);
  knot.P.setZero();
  const TreeMatrix& P = derivative_.a();
  for (int i = 0; i < n; ++i)
    for (const Segment* s = P.sparsity().begin(i); s != P.sparsity().end(i); ++s)
      for (int j = s->begin; j < s->end; ++j) knot.P(i, j) = knot.P(j, i) = P.row(i)[j];
  return status;
}

SolveStatus PlanDynamics::forward(const VectorX& tau, const VectorX* guess) {
  setAppliedForce(tau, data.forces);
  return forwardDynamics(model, guess, data);
}

}  // namespace softgauss::planning

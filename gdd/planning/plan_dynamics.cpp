// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/plan_dynamics.hpp"

#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/inverse.hpp"
#include "softgauss/engine/step/step.hpp"

namespace softgauss::planning {

Knot::Knot(const Model& model, const Transition& step)
    : q(model.q0),
      v(VectorX::Zero(model.nv)),
      last(v),
      a(v),
      tau(v),
      G(MatrixX::Zero(model.nv, 2 * model.nv)),
      P(MatrixX::Zero(model.nv, model.nv)),
      transition(step) {}

PlanDynamics::PlanDynamics(const Model& m, ContactSource* contacts)
    : model(m),
      middle(m),
      data_(std::make_unique<Data>(m)),
      contacts_(contacts),
      step_(*data_, m),
      derivative_(m) {
  input_.tau = VectorX::Zero(m.nv);
  input_.controlled = allTrees(m);
}

void PlanDynamics::restart(ContactSource* contacts) {
  contacts_ = contacts;
  data_ = std::make_unique<Data>(model);
}

SolveStatus PlanDynamics::stages(const Knot& knot) {
  middle.q = knot.q;
  middle.v = knot.v;
  middle.forgetLastStep();
  middle.a = knot.last;
  middle.hasAcceleration = knot.hasLast;
  step_.toMiddle(model, knot.v, middle.q);
  return computeStages(model, input_, middle, *data_, contacts_);
}

SolveStatus PlanDynamics::inverse(Knot& knot) {
  const SolveStatus status = stages(knot);
  return isRefused(status) ? status : inverseDynamics(model, knot.a, *data_, knot.tau);
}

SolveStatus PlanDynamics::linearise(Knot& knot, bool keepsForce) {
  SolveStatus status = stages(knot);
  if (!isRefused(status))
    status = derivative_.compute(model, input_, middle, knot.a, contacts_, *data_);
  if (isRefused(status)) return status;
  if (!keepsForce) knot.tau = derivative_.force();
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

void PlanDynamics::move(const Knot& knot, Knot& next) const {
  next.q = knot.q, next.v = knot.v;
  step_.move(model, knot.a, next.q, next.v);
  next.last = knot.a, next.hasLast = true;
}

SolveStatus PlanDynamics::forward(const VectorX& tau, const VectorX* guess) {
  setAppliedForce(tau, data_->forces);
  return forwardDynamics(model, guess, *data_);
}

}  // namespace softgauss::planning

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/forward_derivative.hpp"

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/step.hpp"

namespace softgauss {

ForwardDerivative::ForwardDerivative(const Model& model)
    : inverse_(model),
      column_(VectorX::Zero(model.nv)),
      q_(MatrixX::Zero(model.nv, model.nv)),
      v_(q_),
      tau_(q_) {}

SolveStatus ForwardDerivative::compute(const Model& model, const Input& input, const State& state,
                                       ContactSource* contacts, Data& data) {
  const SolveStatus status = inverse_.compute(model, input, state, data.forward.a, contacts, data);
  if (isRefused(status)) return status;
  if (!factor_.compute(inverse_.a())) return data.stats.status = SolveStatus::notFinite;
  const auto solve = [&](const MatrixX& right, double sign, MatrixX& x) {
    for (int j = 0; j < model.nv; ++j) {
      column_ = sign * right.col(j);
      factor_.solve(column_);
      x.col(j) = column_;
    }
  };
  solve(inverse_.q(), -1.0, q_);
  solve(inverse_.v(), -1.0, v_);
  tau_.setIdentity();
  solve(tau_, 1.0, tau_);
  return status;
}

StepDerivative::StepDerivative(const Model& model)
    : forward_(model),
      transition_(Data(model, Data::Evaluation{}), model),
      middle_(model),
      a_(VectorX::Zero(model.nv)),
      x_(MatrixX::Zero(2 * model.nv, 2 * model.nv)),
      tau_(MatrixX::Zero(2 * model.nv, model.nv)) {}

Options StepDerivative::bareStep(Options options) {
  options.integrator = Integrator::leapfrog;
  options.stepDoubling = false;
  for (const Mechanism m :
       {Mechanism::midpointVelocity, Mechanism::substepping, Mechanism::treeSubstepping})
    options.mechanisms.remove(m);
  return options;
}

SolveStatus StepDerivative::compute(const Model& model, const Input& input, const State& state,
                                    ContactSource* contacts, Data& data) {
  const Options& o = model.options;
  if (o.integrator != Integrator::leapfrog || o.stepDoubling ||
      o.uses(Mechanism::midpointVelocity) || o.uses(Mechanism::substepping) ||
      o.uses(Mechanism::treeSubstepping))
    throw ModelError({}, "step derivative",
                     "the step is not bare, expected a model with options of "
                     "StepDerivative::bareStep()");
  middle_ = state;
  middle_.forgetLastStep();
  transition_.toMiddle(model, middle_.v, middle_.q);
  SolveStatus status = computeStages(model, input, middle_, data, contacts);
  if (isRefused(status)) return status;
  status = forwardDynamics(model, state, data);
  if (isRefused(status)) return status;
  a_ = data.forward.a;
  const SolveStatus derivative = forward_.compute(model, input, middle_, contacts, data);
  if (isRefused(derivative)) return derivative;

  const int n = model.nv;
  const double h = o.timestep;
  transition_.set(state.v, a_);
  q_ = forward_.q(), v_ = forward_.v();
  transition_.fromMiddle(q_, v_);
  const auto byAcceleration = [&](const MatrixX& a, auto&& x) {
    x.topRows(n) = transition_.byAcceleration().asDiagonal() * a;
    x.bottomRows(n) = h * a;
    for (const Transition::Rotation& r : transition_.rotations())
      x.template middleRows<3>(r.dof) = r.B * a.middleRows<3>(r.dof);
  };
  byAcceleration(forward_.tau(), tau_);
  byAcceleration(q_, x_.leftCols(n));
  byAcceleration(v_, x_.rightCols(n));
  x_.diagonal().array() += 1.0;
  x_.topRightCorner(n, n).diagonal().array() += h;
  for (const Transition::Rotation& r : transition_.rotations()) {
    x_.block<3, 3>(r.dof, r.dof) += r.A_q - Matrix3::Identity();
    x_.block<3, 3>(r.dof, n + r.dof) += r.A_v - h * Matrix3::Identity();
  }
  return status;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/row_differences.hpp"

namespace softgauss {
namespace {

/// Of the planned kinds those without a closed form.
RowKinds equalities(RowKinds planned) {
  RowKinds kinds = RowKinds::none();
  for (const RowKind kind :
       {RowKind::connection, RowKind::weld, RowKind::coupling, RowKind::geometricStiffness})
    if (planned.has(kind)) kinds.insert(kind);
  return kinds;
}

}  // namespace

RowDifferences::RowDifferences(const Model& model, RowKinds planned)
    : state_(model),
      along_(VectorX::Zero(model.nv)),
      more_(model.nv),
      less_(model.nv),
      kinematics_(model),
      equalities_(equalities(planned)) {}

void RowDifferences::force(const Assembly& in, const VectorX& a, VectorX& tau) {
  const Model& model = in.model;
  computeKinematics(model, state_, kinematics_);
  Assembly now{model,   state_,   kinematics_, in.contacts, in.weights,
               in.tree, in.input, nullptr,     in.load,     nullptr};
  if (in.midstepVelocity) {
    midstep_ = *in.midstepVelocity + state_.v - in.state.v;
    setMidstepVelocity(model, midstep_, kinematics_);
    now.midstepVelocity = &midstep_;
  }
  equalities_.assemble(now);
  equalities_.setResidual(a);
  bool changed = false;
  equalities_.evaluate(changed);
  tau.setZero();
  equalities_.addForce(tau);
  tau = -tau;
}

void RowDifferences::addTo(const Assembly& in, const VectorX& a, MatrixX& Gq, MatrixX& Gv) {
  constexpr double kStep = 1e-7;  // impedances bend over a millimetre
  if (equalities_.planned().empty()) return;
  state_ = in.state;
  for (int j = 0; j < in.model.nv; ++j) {
    for (const bool ofPosition : {true, false}) {
      for (const double sign : {1.0, -1.0}) {
        along_[j] = sign * kStep;
        if (ofPosition)
          integratePosition(in.model, along_, 1.0, state_.q);
        else
          state_.v += along_;
        force(in, a, sign > 0.0 ? more_ : less_);
        state_.q = in.state.q, state_.v = in.state.v;
      }
      along_[j] = 0.0;
      (ofPosition ? Gq : Gv).col(j) += (more_ - less_) / (2.0 * kStep);
    }
  }
}

}  // namespace softgauss

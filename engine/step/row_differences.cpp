// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/row_differences.hpp"

#include <algorithm>

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

template <class Rows>
void addForce(const Assembly& in, const VectorX& a, Rows& rows, VectorX& tau) {
  rows.assemble(in);
  if (rows.rowCount() == 0) return;
  rows.multiply(a, rows.x);
  for (std::size_t i = 0; i < rows.x.size(); ++i) rows.x[i] -= rows.reference[i];
  bool changed = false;
  rows.evaluate(changed);
  for (double& f : rows.f) f = -f;
  rows.addTransposed(rows.f, tau);
}

}  // namespace

RowDifferences::RowDifferences(const Model& model, RowKinds planned)
    : state_(model),
      along_(VectorX::Zero(model.nv)),
      more_(model.nv),
      less_(model.nv),
      kinematics_(model),
      equalities_(equalities(planned)) {}

void RowDifferences::force(const Assembly& in, const VectorX& a, ContactSource* contacts,
                           VectorX& tau) {
  const Model& model = in.model;
  computeKinematics(model, state_, kinematics_);
  Assembly now{model,   state_,   kinematics_, in.contacts, in.weights,
               in.tree, in.input, nullptr,     in.load,     nullptr};
  if (in.midstepVelocity) {
    midstep_ = *in.midstepVelocity + state_.v - in.state.v;
    setMidstepVelocity(model, midstep_, kinematics_);
    now.midstepVelocity = &midstep_;
  }
  tau.setZero();
  if (!equalities_.planned().empty()) {
    equalities_.assemble(now);
    equalities_.setResidual(a);
    bool changed = false;
    equalities_.evaluate(changed);
    equalities_.addForce(tau);
    tau = -tau;
  }
  if (pairs_.empty() || !contacts) return;
  contacts->detect(model, kinematics_, found_);
  kept_.clear();
  for (const Contact& c : found_.contacts)
    if (std::find(pairs_.begin(), pairs_.end(), std::pair(c.geometryA, c.geometryB)) !=
        pairs_.end())
      kept_.add(c);
  const Assembly touching{model,   state_,   kinematics_,         kept_,   in.weights,
                          in.tree, in.input, now.midstepVelocity, in.load, nullptr};
  addForce(touching, a, pyramid_, tau);
  addForce(touching, a, cone_, tau);
}

void RowDifferences::addTo(const Assembly& in, const VectorX& a,
                           std::span<const std::pair<int, int>> pairs, ContactSource* contacts,
                           MatrixX& Gq, MatrixX& Gv) {
  // Impedances bend over a millimetre; what is found by iterations has noise.
  const double step = pairs.empty() ? 1e-7 : 1e-6;
  pairs_ = pairs;
  if (equalities_.planned().empty() && (pairs.empty() || !contacts)) return;
  state_ = in.state;
  for (int j = 0; j < in.model.nv; ++j) {
    for (const bool ofPosition : {true, false}) {
      for (const double sign : {1.0, -1.0}) {
        along_[j] = sign * step;
        if (ofPosition)
          integratePosition(in.model, along_, 1.0, state_.q);
        else
          state_.v += along_;
        force(in, a, contacts, sign > 0.0 ? more_ : less_);
        state_.q = in.state.q, state_.v = in.state.v;
      }
      along_[j] = 0.0;
      (ofPosition ? Gq : Gv).col(j) += (more_ - less_) / (2.0 * step);
    }
  }
}

}  // namespace softgauss

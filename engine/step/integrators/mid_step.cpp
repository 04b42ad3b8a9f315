// SPDX-License-Identifier: Apache-2.0
#include "engine/step/integrators/mid_step.hpp"

#include <algorithm>

#include "engine/core/memory.hpp"
#include "engine/step/forward.hpp"
#include "engine/step/gauss_objective.hpp"

namespace softgauss {
namespace {

void evaluateAt(Data& data, const std::vector<double>& references, const VectorX& a) {
  bool changed = false;
  data.constraints.setReferences(references);
  data.constraints.setResidual(a);
  data.constraints.evaluate(changed);
}

}  // namespace

MidStep::MidStep(const Model& model)
    : kinematics_(model),
      state_(model),
      a_(VectorX::Zero(model.nv)),
      middle_(a_),
      Ma_(a_),
      Md_(a_),
      scale_(a_),
      net_(a_),
      change_(a_),
      gradient_(a_),
      direction_(a_) {}

bool MidStep::answer(const Model& model, Data& data, const State& present, const VectorX& vMiddle,
                     const VectorX& bias) {
  ForwardSolution& s = data.forward;
  Constraints& rows = data.constraints;
  state_.q = present.q;
  state_.v = vMiddle;
  kinematics_.X_WB = data.kinematics.X_WB;
  kinematics_.p_WO = data.kinematics.p_WO;
  kinematics_.S = data.kinematics.S;
  computeVelocities(model, data.kinematics, vMiddle, kinematics_.V, kinematics_.A_bias);
  const auto at = [&](const State& x, const Kinematics& k) {
    return Assembly{model, x, k, data.contacts, data.weights, data.inertia.sparsity};
  };
  rows.copyReferences(references_);
  rows.setTurningRay(at(present, data.kinematics), at(state_, kinematics_));
  const auto ofTied = [&](auto&& f) {
    for (std::size_t t = 0; t < model.trees.size(); ++t)
      if (data.followed.tied[t])
        f(model.trees[t].firstDof, model.trees[t].dofEnd - model.trees[t].firstDof);
  };
  change_ = -bias;
  ofTied([&](int first, int dofs) { change_.segment(first, dofs).setZero(); });
  a_ = middle_ = s.a;
  net_ = change_;
  rows.addForceRate(net_);
  rows.subtractRay();
  rows.copyReferences(middleReferences_);
  if (net_.cwiseProduct(s.scale).cwiseAbs().maxCoeff() <= model.options.tolerance) {
    leaveAlone(bias);
    rows.setReferences(references_);
    middleReferences_ = references_;
    return true;
  }

  // What (T.1) is short of at a is none of this: M a − Jᵀf in place of τ − c.
  data.inertia.hat().multiply(a_, Ma_);
  net_ = -Ma_;
  rows.addForce(net_);
  net_ = change_ - net_;
  Md_.swap(s.Md);
  scale_ = s.scale;
  GaussObjective objective(data.inertia, net_, rows, s);
  if (s.cellFactored) objective.keepFactor();
  objective.moveTo(a_);
  const NewtonReport report = minimize(objective, model.options.tolerance,
                                       mostIterations(model.options.maxIterations, rows.rowCount()),
                                       gradient_, direction_, s.cellFactored);
  s.cellFactored = (s.cellFactored || report.factorizations > 0) && !objective.cellChanged();
  data.stats.roundedSolves += report.rounded;
  if (!data.stats.count(report)) return false;
  middle_ = s.a;
  s.a = a_;
  s.Ma = Ma_;
  s.Md.swap(Md_);
  s.scale = scale_;
  rows.setReferences(references_);
  net_ = middle_ - a_;
  data.inertia.hat().multiply(net_, change_);
  ofTied([&](int first, int dofs) { change_.segment(first, dofs) -= bias.segment(first, dofs); });
  return true;
}

void MidStep::leave(Data& data) const { evaluateAt(data, references_, a_); }
void MidStep::enter(Data& data) const {
  evaluateAt(data, middleReferences_, middle_);
  data.constraints.setReferences(references_);
}

std::size_t MidStep::bytes() const {
  return bytesOfAll(kinematics_.X_WB, kinematics_.p_WO, kinematics_.S, kinematics_.V,
                    kinematics_.A_bias, state_.q, state_.v, a_, middle_, Ma_, Md_, scale_, net_,
                    change_, gradient_, direction_, references_, middleReferences_);
}

}  // namespace softgauss

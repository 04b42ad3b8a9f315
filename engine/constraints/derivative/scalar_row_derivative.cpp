// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/derivative/scalar_row_derivative.hpp"

#include <algorithm>

namespace softgauss {
namespace {

constexpr double kStep = 2e-8;  ///< [rad, m, rad/s, m/s]; see contact_law.cpp

/// The row of that name, from `from` on; −1: there is none.
template <class Rows>
int find(const Rows& rows, const RowKey& name, int from) {
  for (int i = from; i < rows.rowCount(); ++i)
    if (rows.name(i) == name) return i;
  for (int i = 0; i < std::min(from, rows.rowCount()); ++i)
    if (rows.name(i) == name) return i;
  return -1;
}

Assembly withState(const Assembly& in, const State& state) {
  return {in.model, state,    in.kinematics,      in.contacts, in.weights,
          in.tree,  in.input, in.midstepVelocity, in.load,     nullptr};
}

}  // namespace

ScalarRowDerivative::ScalarRowDerivative(const Model& model)
    : state_(model), gradient_(VectorX::Zero(model.nv)) {}

template <class Rows>
void ScalarRowDerivative::add(const Assembly& in, const Rows& rows, Rows& more, Rows& less,
                              bool ofPosition, MatrixX& G) {
  if (rows.rowCount() == 0) return;
  state_ = in.state;
  VectorX& x = ofPosition ? state_.q : state_.v;
  const auto shift = [&](double by) {
    if (!ofPosition) x = in.state.v.array() + by;
    for (const Body& body : in.model.bodies)
      if (ofPosition && body.dofs == 1) x[body.q] = in.state.q[body.q] + by;
  };
  shift(kStep);
  more.assemble(withState(in, state_));
  shift(-kStep);
  less.assemble(withState(in, state_));
  for (int row = 0; row < rows.rowCount(); ++row) {
    if (rows.h[row] == 0.0) continue;
    const int up = find(more, rows.name(row), row), down = find(less, rows.name(row), row);
    if (up < 0 && down < 0) continue;
    const double apart = (up < 0 ? 0.0 : kStep) + (down < 0 ? 0.0 : kStep);
    const Rows &high = up < 0 ? rows : more, &low = down < 0 ? rows : less;
    const int highRow = up < 0 ? row : up, lowRow = down < 0 ? row : down;
    const double reference = (high.reference[highRow] - low.reference[lowRow]) / apart;
    const double stiffness = (high.D[highRow] - low.D[lowRow]) / (apart * rows.D[row]);
    const int i = rows.dof(row);
    G(i, i) -= rows.sign(row) * (rows.h[row] * reference + rows.f[row] * stiffness);
  }
}

double ScalarRowDerivative::addInertiaGradient(const Assembly& in, const MassMatrix& inertia,
                                               int body, double scale) {
  const Model& model = in.model;
  const int i = model.bodies[body].v;
  const Motion& S = in.kinematics.S[i];
  // Bodies of a subtree follow its first one.
  for (int b = body + 1; b < model.bodies[body].subtreeEnd; ++b) {
    const int j = model.bodies[b].v;
    gradient_[j] += scale * 2.0 * dot(cross(S, in.kinematics.S[j]), inertia.composite[b] * S);
  }
  double I = inertia.M.row(i)[i];
  if (!model.options.effects.has(Effect::equality)) return I;
  const double q = in.state.q[model.bodies[body].q];
  for (const JointCoupling& c : model.couplings) {
    if (c.leader != body) continue;
    const double slope = c.slope(q);
    const double followers = addInertiaGradient(in, inertia, c.follower, scale * slope * slope);
    I += slope * slope * followers;
  }
  return I;
}

void ScalarRowDerivative::addBorneInertia(const Assembly& in, const JointLimit& rows,
                                          const MassMatrix& inertia, MatrixX& Gq) {
  if (!in.model.options.uses(Mechanism::supportedMass) || rows.rowCount() == 0) return;
  // Rows that a load makes as hard as they are do not ask for the joint's own weight.
  weights_ = in.weights;
  for (double& weight : weights_.dof) weight *= 1.0 + 1e-9;
  limitMore_.assemble({in.model, in.state, in.kinematics, in.contacts, weights_, in.tree, in.input,
                       in.midstepVelocity, in.load, nullptr});
  for (int row = 0; row < rows.rowCount(); ++row) {
    if (rows.h[row] == 0.0 || limitMore_.D[row] != rows.D[row]) continue;
    const int i = rows.dof(row);
    gradient_.setZero();
    const double I = addInertiaGradient(in, inertia, in.model.dofs[i].body, 1.0);
    Gq.row(i) -= rows.sign(row) * rows.f[row] / I * gradient_.transpose();
  }
}

void ScalarRowDerivative::addTo(const Assembly& in, const Constraints& rows,
                                const MassMatrix& inertia, MatrixX& Gq, MatrixX& Gv) {
  add(in, rows.jointLimit, limitMore_, limitLess_, true, Gq);
  add(in, rows.jointLimit, limitMore_, limitLess_, false, Gv);
  add(in, rows.dryFriction, frictionMore_, frictionLess_, false, Gv);
  add(in, rows.servo, servoMore_, servoLess_, true, Gq);
  add(in, rows.servo, servoMore_, servoLess_, false, Gv);
  addBorneInertia(in, rows.jointLimit, inertia, Gq);
}

}  // namespace softgauss

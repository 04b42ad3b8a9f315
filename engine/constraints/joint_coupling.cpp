// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/joint_coupling.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/constraints/carried_inertia.hpp"
#include "softgauss/engine/constraints/connection.hpp"
#include "softgauss/engine/constraints/equality_softness.hpp"

namespace softgauss {
namespace {

/// Whether dof `up` is `down` or one of its ancestors.
bool isAncestor(const Model& model, int up, int down) {
  while (down > up) down = model.dofs[down].parent;
  return down == up;
}

/// L of a coupling (4.6): its follower, or what gear teeth hold of its two sides together.
double coupledLoad(const Assembly& in, const JointCoupling& c, double slope) {
  constexpr double kHolds = 3e3;
  const double m_f = supportedInertia(in, c.follower);
  if (c.leader == 0) return m_f;
  return std::max(m_f, kHolds / (1.0 / m_f + slope * slope / supportedInertia(in, c.leader)));
}

/// A of a coupling's row (4.6); MuJoCo's model takes the two joints without what multiplies them.
double coupledWeight(const Assembly& in, const JointCoupling& c, double slope) {
  const Model& model = in.model;
  const std::vector<double>& w = in.weights.dof;
  const double follower = w[model.bodies[c.follower].v];
  const double leader = c.leader == 0 ? 0.0 : w[model.bodies[c.leader].v];
  if (model.options.constraintModel == ConstraintModel::mujoco) return follower + leader;
  const double feels = follower + slope * slope * leader;
  if (!usesSupportedMass(in, c.impedance)) return feels;
  const double loaded = cappedInverseMass(feels, coupledLoad(in, c, slope));
  in.count(Mechanism::supportedMass, loaded < feels);
  return loaded;
}

}  // namespace

void CouplingRows::assemble(const Assembly& in) {
  const Model& model = in.model;
  pairs_.clear();
  clearRows();
  if (model.options.effects.has(Effect::equality)) {
    for (const JointCoupling& c : model.couplings) {
      if (!in.takesPart(c.follower, c.leader)) continue;
      const Body &follower = model.bodies[c.follower], &leader = model.bodies[c.leader];
      Pair pair{follower.v, follower.v};
      double r = in.state.q[follower.q] - c.polynomial[0];
      double rate = in.state.v[follower.v];
      if (c.leader != 0) {
        const double q = in.state.q[leader.q];
        r = in.state.q[follower.q] - c.value(q);
        pair.leader = leader.v;
        pair.slope = c.slope(q);
        pair.couples =
            !isAncestor(model, std::min(follower.v, leader.v), std::max(follower.v, leader.v));
        rate -= pair.slope * in.state.v[leader.v];
        if (model.options.constraintModel == ConstraintModel::softgauss) pair.bend = c.curvature(q);
      }
      const Softness soft =
          equalitySoftness(c.impedance, r, coupledWeight(in, c, pair.slope), model.options);
      const double turning = -pair.bend * std::pow(in.coriolisVelocity()[pair.leader], 2.0);
      pairs_.push_back(pair);
      rate -= in.velocityLag() * turning;
      r -= 0.5 * in.velocityLag() * in.velocityLag() * turning;
      reference.push_back(soft.referenceAcceleration(rate, r) - turning);
      pushSoftness(soft);
    }
  }
  resizeRows(pairs_.size());
}

void CouplingRows::multiply(const VectorX& a, std::vector<double>& y) const {
  selection.forEach(
      [&](std::size_t i) { y[i] = a[pairs_[i].follower] - pairs_[i].slope * a[pairs_[i].leader]; });
}

void CouplingRows::addTransposed(const std::vector<double>& y, VectorX& tau) const {
  selection.forEach([&](std::size_t i) { addRow(static_cast<int>(i), y[i], tau); });
}

void CouplingRows::addCurvature(TreeMatrix& P) {
  selection.forEach([&](std::size_t i) {
    const Pair& pair = pairs_[i];
    P.row(pair.follower)[pair.follower] += h[i];
    if (pair.leader == pair.follower) return;
    P.row(pair.leader)[pair.leader] += pair.slope * pair.slope * h[i];
    P.row(std::max(pair.follower, pair.leader))[std::min(pair.follower, pair.leader)] -=
        pair.slope * h[i];
  });
}

void CouplingRows::addCurvature(ArticulatedFactor& P) {
  selection.forEach([&](std::size_t i) {
    const Pair& pair = pairs_[i];
    if (pair.leader == pair.follower)
      P.addJoint(pair.follower, h[i]);
    else
      P.addJoints({pair.follower, pair.leader, pair.slope}, h[i]);
  });
}

void CouplingRows::addRow(int i, double scale, VectorX& y) const {
  y[pairs_[i].follower] += scale;
  y[pairs_[i].leader] -= scale * pairs_[i].slope;
}

void CouplingRows::appendCoupledBodies(const Model& model,
                                       std::vector<std::pair<int, int>>& pairs) const {
  for (const Pair& pair : pairs_)
    pairs.emplace_back(model.dofs[idx(pair.follower)].body, model.dofs[idx(pair.leader)].body);
}

void CouplingRows::appendCouplings(std::vector<Segment>& segments, std::vector<int>& setEnd) const {
  for (const Pair& pair : pairs_) {
    if (!pair.couples) continue;
    const auto [first, last] = std::minmax(pair.follower, pair.leader);
    segments.push_back({first, first + 1});
    segments.push_back({last, last + 1});
    setEnd.push_back(static_cast<int>(segments.size()));
  }
}

}  // namespace softgauss

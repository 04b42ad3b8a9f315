// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/substep_selection.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/constraints/contact_rotation.hpp"
#include "softgauss/engine/core/memory.hpp"
#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/integrators/tree_rotation.hpp"

namespace softgauss {

namespace {

/// Of the direction (1, −p′) in which a coupling holds its two joints.
double couplingRate(const Model& model, const State& state, const JointCoupling& c) {
  if (c.leader == 0) return 0.0;
  const Body& leader = model.bodies[c.leader];
  const double q = state.q[leader.q], slope = c.slope(q);
  return std::abs(c.curvature(q) * state.v[leader.v]) / (1.0 + slope * slope);
}

}  // namespace

SubstepSelection::SubstepSelection(const Model& model)
    : partsOf(model.trees.size(), 1),
      coriolisChange(model.trees.size(), 0.0),
      free(model.trees.size(), 0),
      hasEquality_(model.trees.size(), 0),
      touched_(model.trees.size(), 0),
      turns_(model.trees.size(), 0),
      rate_(model.trees.size(), 0.0),
      change_(VectorX::Zero(model.nv)),
      bias_(change_),
      alone_(change_),
      midstep_(change_) {
  const auto tie = [&](int body) {
    if (model.bodies[body].tree >= 0) hasEquality_[model.bodies[body].tree] = 1;
  };
  for (const Connection& c : model.connections) tie(c.bodyA), tie(c.bodyB);
  for (const Weld& w : model.welds) tie(w.bodyA), tie(w.bodyB);
}

std::size_t SubstepSelection::bytes() const {
  return bytesOfAll(partsOf, coriolisChange, free, hasEquality_, touched_, turns_, rate_, change_,
                    bias_, alone_, midstep_);
}

void SubstepSelection::findTouched(const Model& model, const Data& data) {
  touched_ = hasEquality_;
  const auto touch = [&](int body) {
    if (model.bodies[body].tree >= 0) touched_[model.bodies[body].tree] = 1;
  };
  for (const Contact& c : data.contacts.contacts) touch(c.bodyA), touch(c.bodyB);
  data.constraints.visitAllButContacts([&](const auto& c) {
    for (int i = 0; i < c.rowCount(); ++i) touch(c.bodyOf(model, i));
  });
  // A row of a coupling is its follower's.
  if (data.constraints.coupling.rowCount() > 0)
    for (const JointCoupling& c : model.couplings) touch(c.leader);
}

/// How far tree t turns in a step by Δb, `change_` being M⁻¹Δb and `a` the acceleration that made
/// it: (6.4).
double SubstepSelection::coriolisChangeBy(const Model& model, int t, const State& state,
                                          const VectorX& a, Data& data) {
  const double h = model.options.timestep;
  const Tree& tree = model.trees[t];
  const double turned = h * coriolisChangeRate(model, tree, data, state.v, a, change_);
  if (!isPassive(model, tree, hasEquality_[t], data, state.v, state.a)) return turned;
  const auto square = [&](const VectorX& x) {
    return twiceKineticEnergy(model, tree, data.kinematics, data.inertia, x, data.bodies.ray);
  };
  const double moving = square(state.v) + h * h * square(a);
  return std::max(turned, h * energyRate(square(change_), moving));
}

/// turn of every tree that may turn far, of Δb = b(q, v′) − b(q, v) with v′ the velocity of
/// turning.
void SubstepSelection::findCoriolisChanges(const Model& model, const State& state, Data& data) {
  computeBiasAt(model, data.kinematics, data.inertia, state.v, data.active.bodies(),
                data.forces.work, bias_);
  ++data.forces.calls.coriolis;
  for (const Segment s : data.active.dofs())
    part(change_, s) = part(data.forces.bias, s) - part(bias_, s);
  if (!solveMass(model, data, nullptr, change_)) return;  // the solve will say so
  for (const int t : data.active.trees())
    if (turns_[t]) coriolisChange[t] = coriolisChangeBy(model, t, state, state.a, data);
}

/// change_ ← M⁻¹Δb of v″ = v′ + ½ h alone_, alone_ = −M⁻¹c with the Coriolis forces c(q, v′).
bool SubstepSelection::findAlone(const Model& model, Data& data) {
  const auto bias = [&](const VectorX& v, VectorX& b) {
    computeBiasAt(model, data.kinematics, data.inertia, v, data.active.bodies(), data.forces.work,
                  b);
    ++data.forces.calls.coriolis;
  };
  const Segments dofs = data.active.dofs();
  setZero(dofs, alone_);
  bias(alone_, change_);
  for (const Segment s : dofs) part(alone_, s) = part(change_, s) - part(data.forces.bias, s);
  if (!solveMass(model, data, nullptr, alone_)) return false;
  for (const Segment s : dofs)
    part(midstep_, s) =
        part(data.midstepVelocity, s) + 0.5 * model.options.timestep * part(alone_, s);
  bias(midstep_, change_);
  for (const Segment s : dofs) part(change_, s) -= part(data.forces.bias, s);
  return solveMass(model, data, nullptr, change_);
}

/// A control acts on the tree, or applied forces that change its motion by more than a thousandth.
bool SubstepSelection::driven(const Model& model, const Data& data, const State& state, int t,
                              bool controlled) const {
  const Tree& tree = model.trees[t];
  if (controlled)
    for (int i = tree.firstDof; i < tree.dofEnd; ++i)
      if (model.dofs[i].actuated) return true;
  return drives(tree, data, state.v, state.a, model.options.timestep);
}

/// Trees that are followed by themselves, but for those that need too many parts.
void SubstepSelection::findFree(const Model& model, const Data& data, const State& state,
                                bool controlled) {
  findTouched(model, data);
  for (const int t : data.active.trees()) {
    free[t] = !touched_[t] && !stopsWithin(model, model.trees[t], data) &&
              !movesEvenly(model, model.trees[t], state.v) &&
              !driven(model, data, state, t, controlled);
    anyFree = anyFree || free[t];
  }
}

/// r of the trees of two bodies ← at least rate(), where one of them may turn far.
template <class Rate>
void SubstepSelection::raise(const Model& model, int bodyA, int bodyB, Rate&& rate) {
  const int trees[] = {model.bodies[bodyA].tree, model.bodies[bodyB].tree};
  if (std::ranges::none_of(trees, [&](int t) { return t >= 0 && turns_[t]; })) return;
  const double r = rate();
  for (const int t : trees)
    if (t >= 0) rate_[t] = std::max(rate_[t], r);
}

void SubstepSelection::findContactRates(const Model& model, const Data& data) {
  for (const Contact& c : data.contacts.contacts)
    if (!(model.options.hasRowLaw() && c.distance > 0.0))
      raise(model, c.bodyA, c.bodyB,
            [&] { return contactRotationRate(model, data.kinematics, c); });
}

void SubstepSelection::findTieRates(const Model& model, const Data& data, const State& state) {
  const std::vector<Motion>& V = data.kinematics.midstepVelocities();
  const auto tie = [&](int a, int b) {
    raise(model, a, b, [&] { return 4.0 * std::max(V[a].angular.norm(), V[b].angular.norm()); });
  };
  for (const Connection& c : model.connections) tie(c.bodyA, c.bodyB);
  for (const Weld& w : model.welds) tie(w.bodyA, w.bodyB);
  for (const JointCoupling& c : model.couplings)
    raise(model, c.leader, c.follower, [&] { return 4.0 * couplingRate(model, state, c); });
}

/// (6.3) of every tree that is not free.
void SubstepSelection::findRates(const Model& model, const State& state, Data& data) {
  constexpr double kLeast = 1e-4;  // of turn
  const double h = model.options.timestep, angle = model.options.substepAngle;
  if (state.hasAcceleration) findCoriolisChanges(model, state, data);
  findContactRates(model, data);
  findTieRates(model, data, state);
  const auto rateOf = [&](int t) { return 4.0 * std::sqrt(2.0 * coriolisChange[t]) / h; };
  bool alone = false;
  for (const int t : data.active.trees()) {
    if (!turns_[t] || !(coriolisChange[t] > kLeast)) continue;
    const bool tooMany = !(h * rateOf(t) <= kMaxDivisions * angle);
    if (tooMany && model.options.uses(Mechanism::treeSubstepping) && !touched_[t] &&
        !stopsWithin(model, model.trees[t], data)) {
      free[t] = 1, anyFree = true;
      continue;
    }
    if (h * rateOf(t) > angle) {
      if (!alone) alone = findAlone(model, data);
      if (alone)
        coriolisChange[t] =
            std::min(coriolisChange[t], coriolisChangeBy(model, t, state, state.a, data));
    }
    rate_[t] = std::max(rate_[t], rateOf(t));
  }
}

/// turns_; false where no tree does.
bool SubstepSelection::findTurning(const Model& model, const Data& data, const State& state) {
  bool any = false;
  std::fill(turns_.begin(), turns_.end(), 0);
  for (const int t : data.active.trees()) {
    turns_[t] = !free[t] && mayRotateFar(model, model.trees[t], data, state.v, state.a);
    any = any || turns_[t];
  }
  return any;
}

void SubstepSelection::find(const Model& model, const State& state, bool controlled, Data& data) {
  parts = 1;
  anyFree = false;
  std::fill(partsOf.begin(), partsOf.end(), 1);
  std::fill(free.begin(), free.end(), 0);
  std::fill(coriolisChange.begin(), coriolisChange.end(), 0.0);
  if (!data.plan.coriolis || model.options.substepAngle == kInfinity) return;
  if (model.options.uses(Mechanism::treeSubstepping)) findFree(model, data, state, controlled);
  if (!findTurning(model, data, state)) return;
  std::fill(rate_.begin(), rate_.end(), 0.0);
  findRates(model, state, data);
  if (!model.options.uses(Mechanism::substepping)) return;
  for (const int t : data.active.trees()) {
    if (free[t]) continue;
    const double needed =
        std::ceil(model.options.timestep * rate_[t] / model.options.substepAngle - 1e-9);
    partsOf[t] = needed < kMaxDivisions ? std::max(1, static_cast<int>(needed)) : kMaxDivisions;
    parts = std::max(parts, partsOf[t]);
  }
}

}  // namespace softgauss

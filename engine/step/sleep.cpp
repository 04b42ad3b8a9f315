// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/sleep.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/step/integrators/tunnelling.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {
namespace {

/// Radius of gyration of each body about its centre of mass, the mean over all axes [m].
std::vector<double> gyrationRadii(const Model& model) {
  std::vector<double> radii;
  for (const Body& body : model.bodies) {
    const double trace = body.I_Bcm.xx + body.I_Bcm.yy + body.I_Bcm.zz;
    radii.push_back(body.mass > 0.0 ? std::sqrt(trace / (3.0 * body.mass)) : 0.0);
  }
  return radii;
}

/// What a rotor's speed is worth, √(armature / mass of its tree), the mass 1 kg where it has none:
/// a rotor turns unseen by the links.
std::vector<double> rotorLevers(const Model& model) {
  std::vector<double> levers;
  for (const Dof& dof : model.dofs) {
    const double mass = model.trees[idx(model.bodies[idx(dof.body)].tree)].mass;
    levers.push_back(std::sqrt(dof.armature / (mass > 0.0 ? mass : 1.0)));
  }
  return levers;
}

/// The fastest link of a tree that moves by V: its centre of mass, and its radius of gyration
/// [m/s]; of links up to one that is faster than `most`.
double fastestLink(const Model& model, const Kinematics& k, const Tree& tree,
                   const std::vector<double>& gyration, const std::vector<Motion>& V, double most) {
  double fastest = 0.0;
  for (int b = tree.rootBody; b < tree.bodyEnd && fastest <= most; ++b) {
    const Body& body = model.bodies[idx(b)];
    if (body.massless) continue;
    const Vector3 com = k.X_WB[idx(b)] * body.com - k.p_WO[idx(body.tree)];
    const Vector3 v = V[idx(b)].linear + V[idx(b)].angular.cross(com);
    fastest = std::max(fastest, v.norm() + gyration[idx(b)] * V[idx(b)].angular.norm());
  }
  return fastest;
}

bool sameBits(Segments entries, const VectorX& x, const VectorX& y) {
  return std::ranges::all_of(entries, [&](Segment s) {
    return std::memcmp(x.data() + s.begin, y.data() + s.begin,
                       idx(s.end - s.begin) * sizeof(double)) == 0;
  });
}

Segment dofsOf(const Tree& tree) { return {tree.firstDof, tree.dofEnd}; }

bool isZero(const VectorX& x, Segment s) { return (part(x, s).array() == 0.0).all(); }

/// The tree that a wrench pushes, −1: none.
int pushedBy(const Model& model, const ExternalWrench& w) {
  const bool none = w.F_Bo_W.force.isZero(0.0) && w.F_Bo_W.moment.isZero(0.0);
  return none ? -1 : model.bodies[idx(w.body)].tree;
}

/// What a servo is told to do.
double asked(const VectorX& input, int dof, double own) {
  return input.size() > 0 ? input[dof] : own;
}

/// Whether the servos of these dofs are told what they were told in the last step, and no rate;
/// `sleep` has it from now on.
bool keepsSetPoints(const Model& model, const Input& input, Segment dofs, SleepState& sleep) {
  bool same = true;
  for (int i = dofs.begin; i < dofs.end && sleep.setPoint.size() == model.nv; ++i) {
    const Servo& servo = model.dofs[idx(i)].servo;
    if (!servo.exists()) continue;
    const double place = asked(input.setPoint, i, servo.setPoint);
    const double rate = asked(input.setPointRate, i, servo.setPointRate);
    same = same && rate == 0.0 && place == sleep.setPoint[i] && rate == sleep.setPointRate[i];
    sleep.setPoint[i] = place;
    sleep.setPointRate[i] = rate;
  }
  return same;
}

}  // namespace

Sleepers::Sleepers(const Model& model)
    : still_(model),
      known_(model.trees.size(), -1),
      q_(model.q0),
      seenAt_(VectorX::Constant(model.nq, kNaN)),
      marked_(model.trees.size(), 0),
      gyration_(gyrationRadii(model)),
      rotor_(rotorLevers(model)),
      V_(model.bodies.size()),
      islands_(model),
      applied_(VectorX::Zero(model.nv)),
      tau_(applied_) {
  if (!mayBeOf(model.options)) throw ModelError({}, "sleep", kIntegrators);
  still_.select(model, [](int) { return false; });
  before_.reserve(model.trees.size());
  least_.reserve(model.trees.size());
  first_.reserve(model.trees.size());
  for (const Geometry& g : model.geometries) treeOf_.push_back(model.bodies[idx(g.body)].tree);
}

void Sleepers::select(const Model& model, const State& state, Data& data) {
  const std::vector<int>& island = state.sleep.island;
  const bool any = !island.empty();
  if (any ? island == known_ : still_.none()) return;
  known_.assign(model.trees.size(), -1);
  if (any) known_ = island;
  still_.select(model, [&](int tree) { return known_[idx(tree)] >= 0; });
  data.active.select(model, [&](int tree) { return known_[idx(tree)] < 0; });
  data.active.setStill(still_.none() ? std::span<const std::uint8_t>{} : still_.flags());
  placed_ = false;
}

void Sleepers::forget(const Model& model, Data& data) {
  select(model, State(), data);  // a state in which nobody sleeps
}

/// A force or a velocity that is not zero.
void Sleepers::markPushed(const Model& model, const Input& input, const State& state) {
  for (const VectorX* x : {&input.tau, &state.v}) {
    const Segments dofs = still_.dofs();
    if (x->size() == 0 || std::ranges::all_of(dofs, [&](Segment s) { return isZero(*x, s); }))
      continue;
    for (const int t : still_.trees())
      if (!isZero(*x, dofsOf(model.trees[idx(t)]))) mark(t);
  }
  for (const ExternalWrench& w : input.wrenches)
    if (const int tree = pushedBy(model, w); tree >= 0) mark(tree);
}

/// Servos that are told something new.
void Sleepers::markServoed(const Model& model, const Input& input, const SleepState& sleep) {
  if (sleep.setPoint.size() != model.nv || sleep.setPointRate.size() != model.nv) return;
  for (const Segment s : still_.dofs())
    for (int i = s.begin; i < s.end; ++i) {
      const Dof& dof = model.dofs[idx(i)];
      if (!dof.servo.exists()) continue;
      if (asked(input.setPoint, i, dof.servo.setPoint) != sleep.setPoint[i] ||
          asked(input.setPointRate, i, dof.servo.setPointRate) != sleep.setPointRate[i])
        mark(model.bodies[idx(dof.body)].tree);
    }
}

void Sleepers::rouse(const Model& model, State& state, Data& data) {
  if (!std::exchange(anyMarked_, false)) return;
  bool any = false;
  for (const int t : still_.trees()) {
    if (marked_[idx(t)] == 0 || !state.sleep.isAsleep(t)) continue;
    if (!woke_) before_ = known_;
    any = woke_ = true;
    wake(state.sleep, t);
  }
  std::ranges::fill(marked_, 0);
  if (!any) return;
  const int asleepBefore = asleep();
  select(model, state, data);
  wokenTrees_ += asleepBefore - asleep();
}

/// Kinematics, inertias and poses of shapes, of who sleeps, are made where they are not known, or
/// are those of other places. All else that the stages have of them is zero.
BadInput Sleepers::place(const Model& model, State& state, Data& data, ContactSource* contacts) {
  if (still_.none()) return {};
  const std::int64_t detections = contacts ? contacts->fullDetections() : 0;
  if (placed_ && source_ == contacts && detections_ == detections &&
      sameBits(still_.coordinates(), q_, state.q))
    return {};
  if (!allFinite(still_.coordinates(), state.q)) {  // the step will refuse it
    for (const int t : still_.trees()) mark(t);
    rouse(model, state, data);
    return {};
  }
  if (const BadInput bad = findBadQuaternion(model, state.q, still_.bodies())) return bad;
  computeKinematics(model, state, data.kinematics);
  computeMassMatrix(model, data.kinematics, still_.bodies(), still_.dofs(), data.inertia, true);
  data.inertia.Mhat.assign(data.inertia.M, still_.dofs());
  for (VectorX* x : {&data.forces.bias, &data.forces.c, &data.forces.push, &data.forces.tau,
                     &data.forces.net, &data.forward.a, &data.acceleration})
    setZero(still_.dofs(), *x);
  if (data.parts && data.parts->islands)
    computeKinematics(model, state, data.parts->islands->data.kinematics);
  if (looksForContacts(data, contacts)) contacts->detect(model, data.kinematics, all_);
  forgetElsewhere(model, state.q);
  q_ = state.q;
  source_ = contacts;
  detections_ = contacts ? contacts->fullDetections() : 0;
  placed_ = true;
  return {};
}

/// What is kept of a sleeper for others to see is of the place where these Data saw it fall asleep.
void Sleepers::forgetElsewhere(const Model& model, const VectorX& q) {
  for (const int t : still_.trees()) {
    const Tree& tree = model.trees[idx(t)];
    const Segment at = coordinatesOf(model, tree);
    if (sameBits({&at, 1}, seenAt_, q)) continue;
    part(applied_, dofsOf(tree)).setZero();
    std::erase_if(contacts_, [&](const Snapshot::ContactForce& c) {
      return treeOf_[idx(c.geometryA)] == t || treeOf_[idx(c.geometryB)] == t;
    });
  }
}

void Sleepers::forgetSeen() {
  contacts_.clear();
  applied_.setZero();
  seenAt_.setConstant(kNaN);
}

BadInput Sleepers::begin(const Model& model, const Input& input, StepControl* control, State& state,
                         Data& data, ContactSource* contacts) {
  woke_ = false;
  wokenTrees_ = 0;
  if (still_.none()) return {};
  markPushed(model, input, state);
  markServoed(model, input, state.sleep);
  if (control && state.sleep.lastTime > -kInfinity)
    anyMarked_ |= control->markChanged(model, state.sleep.lastTime, state.time, marked_);
  return wakeMarked(model, state, data, contacts);
}

bool Sleepers::mark(std::span<const std::uint8_t> trees) {
  bool any = false;
  for (std::size_t t = 0; t < trees.size(); ++t)
    if (trees[t] != 0 && still_.has(static_cast<int>(t))) mark(static_cast<int>(t)), any = true;
  return any;
}

bool Sleepers::touches(const Model& model, const ContactSet& contacts) {
  if (still_.none()) return false;
  bool any = false;
  for (const Contact& c : contacts.contacts)
    for (const int body : {c.bodyA, c.bodyB})
      if (body != 0 && still_.has(model.bodies[idx(body)].tree)) {
        mark(model.bodies[idx(body)].tree);
        any = true;
      }
  return any;
}

BadInput Sleepers::wakeMarked(const Model& model, State& state, Data& data,
                              ContactSource* contacts) {
  rouse(model, state, data);
  return place(model, state, data, contacts);
}

void Sleepers::undo(State& state) const {
  if (woke_) state.sleep.island = before_;
}

/// Whether a tree is slow, and goes on as it was when it came to rest. Speeds below a thousandth of
/// Sleep::speed are rounding.
bool Sleepers::rests(const Model& model, int t, SleepState& sleep, const VectorX& v,
                     const Data& data) {
  const double most = model.options.sleep.speed;
  const Tree& tree = model.trees[idx(t)];
  const Segment bodies{tree.rootBody, tree.bodyEnd}, dofs = dofsOf(tree);
  const Kinematics& k = data.kinematics;
  moveBodies(model, k, {&bodies, 1}, v, V_);
  double fastest = fastestLink(model, k, tree, gyration_, V_, most);
  for (int i = dofs.begin; i < dofs.end; ++i)
    fastest = std::max(fastest, rotor_[idx(i)] * std::abs(v[i]));
  if (!(fastest <= most)) return false;
  if (sleep.restTime[idx(t)] == 0.0) {
    sleep.restSpeed[idx(t)] = std::max(fastest, 1e-3 * most);
    part(sleep.restVelocity, dofs) = part(v, dofs);
    return true;
  }
  part(tau_, dofs) = part(v, dofs) - part(sleep.restVelocity, dofs);
  moveBodies(model, k, {&bodies, 1}, tau_, V_);
  return fastest <= sleep.restSpeed[idx(t)] &&
         fastestLink(model, k, tree, gyration_, V_, most) <= 0.1 * most;
}

void Sleepers::finish(const Model& model, const Input& input, const StepControl* control,
                      double began, State& state, Data& data) {
  data.stats.asleepTrees = asleep();
  data.stats.wokenTrees = wokenTrees_;
  if (state.sleep.island.empty()) state.sleep = State(model).sleep;
  state.sleep.lastTime = began;
  const Sleep& sleep = model.options.sleep;
  for (const int t : data.active.trees()) {
    const Segment dofs = dofsOf(model.trees[idx(t)]);
    const bool may = keepsSetPoints(model, input, dofs, state.sleep) &&
                     (!control || control->letsSleep(model, t, state.time)) &&
                     (input.tau.size() == 0 || isZero(input.tau, dofs));
    double& time = state.sleep.restTime[idx(t)];
    time = may && rests(model, t, state.sleep, state.v, data) ? time + model.options.timestep : 0.0;
  }
  for (const ExternalWrench& w : input.wrenches)
    if (const int tree = pushedBy(model, w); tree >= 0) state.sleep.restTime[idx(tree)] = 0.0;
  const bool any = std::ranges::any_of(
      data.active.trees(), [&](int t) { return state.sleep.restTime[idx(t)] >= sleep.time; });
  if (any) findRested(model, data, state.sleep);
  if (std::exchange(anyMarked_, false)) fallAsleep(model, state, data);
}

/// Marks the trees of islands of which all have been at rest for long.
void Sleepers::findRested(const Model& model, const Data& data, const SleepState& sleep) {
  pairs_.assign(data.bodies.tied.begin(), data.bodies.tied.end());
  appendTouching(model, data, pairs_);
  islands_.find(model, pairs_, data.active.still());
  const auto islandOf = [&](int t) {
    return idx(islands_.ofBody()[idx(model.trees[idx(t)].rootBody)]);
  };
  least_.assign(idx(islands_.size()), kInfinity);
  for (const int t : data.active.trees())
    least_[islandOf(t)] = std::min(least_[islandOf(t)], sleep.restTime[idx(t)]);
  for (const int t : data.active.trees())
    if (least_[islandOf(t)] >= model.options.sleep.time) mark(t);
}

void Sleepers::fallAsleep(const Model& model, State& state, Data& data) {
  SleepState& sleep = state.sleep;
  const auto isMarked = [&](int tree) { return tree >= 0 && marked_[idx(tree)] != 0; };
  std::erase_if(contacts_, [&](const Snapshot::ContactForce& c) { return !isStill(c); });
  contactForces(data, found_);
  for (const Snapshot::ContactForce& c : found_)
    if (isMarked(treeOf_[idx(c.geometryA)]) || isMarked(treeOf_[idx(c.geometryB)]))
      contacts_.push_back(c);
  appliedForces(data, tau_);
  first_.assign(idx(islands_.size()), -1);
  for (const int t : data.active.trees()) {
    if (!isMarked(t)) continue;
    const Tree& tree = model.trees[idx(t)];
    int& first = first_[idx(islands_.ofBody()[idx(tree.rootBody)])];
    if (first < 0) first = t;
    sleep.island[idx(t)] = first;
    sleep.restTime[idx(t)] = 0.0;
    const Segment dofs = dofsOf(tree);
    part(applied_, dofs) = part(tau_, dofs);
    const Segment at = coordinatesOf(model, tree);
    part(seenAt_, at) = part(state.q, at);
    for (VectorX* x : {&state.v, &state.a, &state.warmstart.a}) part(*x, dofs).setZero();
  }
  std::ranges::fill(marked_, 0);
}

bool Sleepers::isStill(const Snapshot::ContactForce& c) const {
  const auto still = [&](int geometry) {
    const int tree = treeOf_[idx(geometry)];
    return tree >= 0 && still_.has(tree);
  };
  return still(c.geometryA) || still(c.geometryB);
}

void Sleepers::appendContacts(std::vector<Snapshot::ContactForce>& contacts) const {
  for (const Snapshot::ContactForce& c : contacts_)
    if (isStill(c)) contacts.push_back(c);
}

void Sleepers::copyApplied(VectorX& tau) const { copy(still_.dofs(), applied_, tau); }

}  // namespace softgauss

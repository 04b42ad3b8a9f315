// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/islands/islands.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "softgauss/engine/core/index.hpp"

namespace softgauss {
namespace {

/// What Input has of every dof.
constexpr VectorX Input::*kInputVectors[] = {&Input::tau, &Input::setPoint, &Input::setPointRate};

std::vector<int> treesOf(const Units& units, const std::vector<int>& some) {
  std::vector<int> trees;
  for (const int unit : some)
    trees.insert(trees.end(), units.trees[idx(unit)].begin(), units.trees[idx(unit)].end());
  std::sort(trees.begin(), trees.end());
  return trees;
}

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
    const Tree& tree = model.trees[idx(model.bodies[idx(dof.body)].tree)];
    double mass = 0.0;
    for (int b = tree.rootBody; b < tree.bodyEnd; ++b) mass += model.bodies[idx(b)].mass;
    levers.push_back(std::sqrt(dof.armature / (mass > 0.0 ? mass : 1.0)));
  }
  return levers;
}

/// Velocity of a link's centre of mass, and of its radius of gyration [m/s].
Motion linkVelocity(const Islands::Island& island, int b) {
  const Kinematics& k = island.end;
  const Body& body = island.part.model.bodies[idx(b)];
  const Motion& V = k.V[idx(b)];
  const Vector3 com = k.X_WB[idx(b)] * body.com - k.p_WO[idx(body.tree)];
  Motion v;
  v.angular = island.gyration[idx(b)] * V.angular;
  v.linear = V.linear + V.angular.cross(com);
  return v;
}

double sizeOf(const Motion& v) { return v.linear.norm() + v.angular.norm(); }

}  // namespace

Islands::Island::Island(const Model& whole, std::vector<int> ofUnits, const std::vector<int>& trees,
                        IslandContacts* source, IslandControls* controls)
    : units(std::move(ofUnits)),
      part(whole, trees),
      contacts(source ? source->within(part) : nullptr),
      control(controls ? controls->within(part) : nullptr),
      state(part.model),
      data(part.model),
      end(part.model),
      gyration(gyrationRadii(part.model)),
      rotor(rotorLevers(part.model)),
      rest(part.model.bodies.size()) {}

Islands::Islands(const Model& model, IslandContacts* contacts, Sleep sleep,
                 IslandControls* controls)
    : model_(model), contacts_(contacts), controls_(controls), sleep_(sleep), units_(model) {
  const Integrator integrator = model.options.integrator;
  if ((integrator != Integrator::semiImplicitEuler && integrator != Integrator::leapfrog) ||
      model.options.stepDoubling)
    throw ModelError({}, "islands",
                     "are stepped by semi-implicit-euler or leapfrog, not by " +
                         std::string(integratorName(model.options.integrator)) +
                         ", which evaluates the dynamics within the step");
  islandOf_.resize(idx(units_.size()), nullptr);
  groupOf_.resize(idx(units_.size()), 0);
  acceleration_ = VectorX::Zero(model.nv);
  setPoints_.fill(acceleration_);
  setState(State(model));
}

Islands::~Islands() = default;

void Islands::setState(const State& state) {
  state_ = state;
  for (Island* island : islandOf_)
    if (island && island->active) deactivate(*island);
  for (int unit = 0; unit < units_.size(); ++unit) activate(find({unit}));
  refreshLists();
}

void Islands::wake(int body) {
  const int unit = units_.ofBody(model_, body);
  if (unit >= 0) wake(*islandOf_[idx(unit)]);
  refreshLists();
}

bool Islands::asleep(int body) const {
  const int unit = units_.ofBody(model_, body);
  return unit >= 0 && !islandOf(unit).awake;
}

Islands::Island& Islands::find(const std::vector<int>& units) {
  std::unique_ptr<Island>& island = islands_[units];
  if (!island)
    island = std::make_unique<Island>(model_, units, treesOf(units_, units), contacts_, controls_);
  return *island;
}

void Islands::activate(Island& island) {
  island.active = true;
  island.age = 0;
  island.awake = false;
  ++active_;
  for (const int unit : island.units) {
    islandOf_[idx(unit)] = &island;
    groupOf_[idx(unit)] = island.units.front();
  }
  wake(island);
  place(island);
}

void Islands::place(const Island& island) {
  if (!contacts_) return;
  for (std::size_t t = 0; t < island.part.trees.size(); ++t) {
    const Tree& tree = island.part.model.trees[t];
    const Kinematics& k = island.data.kinematics;
    const auto from = idx(tree.rootBody), count = idx(tree.bodyEnd - tree.rootBody);
    contacts_->place(island.part.trees[t], {std::span(k.X_WB).subspan(from, count),
                                            std::span(k.V).subspan(from, count), &k.p_WO[t]});
  }
}

void Islands::deactivate(Island& island) {
  island.active = island.awake = false;
  --active_;
}

/// Reads the island's state.
void Islands::wake(Island& island) {
  if (island.awake) return;
  island.part.gather(model_, state_, island.state);
  island.awake = true;
  island.resting = 0.0;
  awake_.push_back(&island);
}

void Islands::fallAsleep(Island& island) {
  island.awake = false;
  island.state.v.setZero();
  island.state.warmstart.a.setZero();
  island.state.a.setZero();
  island.part.scatter(model_, island.state, state_);
  island.part.scatter(model_, island.state.v, acceleration_);
  computeKinematics(island.part.model, island.state, island.data.kinematics);
  place(island);
}

void Islands::refreshLists() {
  std::erase_if(awake_, [](const Island* i) { return !i->active || !i->awake; });
  const auto before = [](const Island* x, const Island* y) {
    return x->units.front() < y->units.front();
  };
  std::sort(awake_.begin(), awake_.end(), before);
  awake_.erase(std::unique(awake_.begin(), awake_.end()), awake_.end());
  awakeUnits_.clear();
  for (const Island* island : awake_)
    awakeUnits_.insert(awakeUnits_.end(), island->units.begin(), island->units.end());
  std::sort(awakeUnits_.begin(), awakeUnits_.end());
}

void Islands::push(int tree) {
  Island& island = *islandOf_[idx(units_.ofTree[idx(tree)])];
  if (!island.awake) ++islandStats_.wakeups, wake(island);
  island.resting = 0.0;
}

/// A force that is not zero keeps an island awake, and wakes it.
void Islands::wakeWhatIsPushed(const Input& input) {
  if (input.tau.size() > 0)
    for (std::size_t t = 0; t < model_.trees.size(); ++t) {
      const Tree& tree = model_.trees[t];
      const auto force = input.tau.segment(tree.firstDof, tree.dofEnd - tree.firstDof);
      if (!(force.array() == 0.0).all()) push(static_cast<int>(t));
    }
  for (const ExternalWrench& w : input.wrenches) {
    const bool none = w.F_Bo_W.force.isZero(0.0) && w.F_Bo_W.moment.isZero(0.0);
    const int tree = model_.bodies[idx(w.body)].tree;
    if (!none && tree >= 0) push(tree);
  }
}

/// Where servos are told something new, their islands wake.
void Islands::wakeWhatIsServoed(const Input& input) {
  const VectorX* const asked[] = {&input.setPoint, &input.setPointRate};
  for (int i = 0; i < model_.nv; ++i) {
    const Dof& dof = model_.dofs[idx(i)];
    if (!dof.servo.exists()) continue;
    for (const std::size_t k : {0, 1}) {
      const double own = k == 0 ? dof.servo.setPoint : dof.servo.setPointRate;
      const double now = asked[k]->size() > 0 ? (*asked[k])[i] : own;
      if (now != std::exchange(setPoints_[k][i], now)) push(model_.bodies[idx(dof.body)].tree);
    }
  }
}

/// Where what controls an island begins, ends or has changed, it wakes.
void Islands::wakeWhatIsControlled() {
  if (!controls_) return;
  changed_.clear();
  controls_->begin(state_.time, changed_);
  for (const int tree : changed_) push(tree);
}

/// One step of an island.
SolveStatus Islands::take(Island& island, const Input& input) {
  Input& part = island.input;
  for (const auto x : kInputVectors) {
    (part.*x).resize((input.*x).size() > 0 ? island.part.model.nv : 0);
    if ((input.*x).size() > 0) island.part.gather(model_, input.*x, part.*x);
  }
  part.controlled.clear();
  if (!input.controlled.empty())
    for (const int tree : island.part.trees) part.controlled.push_back(input.controlled[idx(tree)]);
  part.wrenches.clear();
  for (ExternalWrench wrench : input.wrenches) {
    const int unit = units_.ofBody(model_, wrench.body);
    if (unit < 0 || islandOf_[idx(unit)] != &island) continue;
    wrench.body = island.part.bodyOf(model_, wrench.body);
    part.wrenches.push_back(wrench);
  }
  const Model& model = island.part.model;
  State& state = island.state;
  island.controlled = island.control && island.control->acts(state_.time);
  if (island.controlled)
    return island.control->step(part, state, island.data, island.contacts.get());
  if (island.control) island.control->release();
  const SolveStatus status =
      softgauss::step(model, part, state, island.data, island.contacts.get(), nullptr, true);
  if (controls_ && !isRefused(status)) {  // a control that comes to act starts from there
    state.warmstart.gddA = state.warmstart.a;
    state.warmstart.multipliers.setZero();
    state.warmstart.control.setZero();
    state.warmstart.breakpoints.clear();
  }
  return status;
}

SolveStatus Islands::step(const Input& input) noexcept {
  stats_ = {};
  islandStats_ = {};
  if (stats_.refuse(model_, findBadInput(model_, input, state_))) return stats_.status;

  wakeWhatIsPushed(input);
  wakeWhatIsServoed(input);
  wakeWhatIsControlled();
  if (islandStats_.wakeups > 0) refreshLists();
  for (Island* island : awake_) poseForStep(island->part.model, island->state, island->data);
  part();
  join();
  for (Island* island : awake_)
    if (isRefused(take(*island, input))) return fail(*island);

  // All went well: what the islands have found becomes the state.
  ++clock_;
  state_.time += model_.options.timestep;
  state_.warmstart.valid = true;
  for (Island* island : awake_) {
    island->part.scatter(model_, island->state, state_);
    const Data& data = island->data;
    island->part.scatter(model_, data.plan.drifts ? data.acceleration : data.forward.a,
                         acceleration_);
    island->lastUse = clock_;
    ++island->age;
    if (island->controlled) state_.warmstart.gddValid = true;
  }
  collectStats();
  if (sleep_.enabled) settle();
  return stats_.status;
}

/// The state is as before the step in every island.
SolveStatus Islands::fail(const Island& island) {
  stats_ = island.data.stats;
  if (stats_.badDof >= 0) {
    const int tree =
        island.part.model.bodies[idx(island.part.model.dofs[idx(stats_.badDof)].body)].tree;
    stats_.badDof += model_.trees[idx(island.part.trees[idx(tree)])].firstDof -
                     island.part.model.trees[idx(tree)].firstDof;
  }
  for (Island* other : awake_) other->part.gather(model_, state_, other->state);
  return stats_.status;
}

/// Whether the island is slow, and goes on as it was when it began to rest. Speeds below a
/// thousandth of Sleep::speed are rounding.
bool Islands::rests(Island& island) const {
  const Model& model = island.part.model;
  computeKinematics(model, island.state, island.end);
  const bool begins = island.resting == 0.0;
  double fastest = 0.0, change = 0.0;
  for (int b = 1; b < model.bodyCount(); ++b) {
    if (model.bodies[idx(b)].massless) continue;
    const Motion v = linkVelocity(island, b);
    fastest = std::max(fastest, sizeOf(v));
    Motion& rest = island.rest[idx(b)];
    if (begins) rest = v;
    change = std::max(change, (v.linear - rest.linear).norm() + (v.angular - rest.angular).norm());
  }
  for (int i = 0; i < model.nv; ++i)
    fastest = std::max(fastest, island.rotor[idx(i)] * std::abs(island.state.v[i]));
  if (!(fastest <= sleep_.speed)) return false;
  if (begins) island.restSpeed = std::max(fastest, 1e-3 * sleep_.speed);
  return change <= 0.1 * sleep_.speed && fastest <= island.restSpeed;
}

void Islands::settle() {
  bool changed = false;
  for (Island* island : awake_) {
    const bool mayRest =
        !island->controlled || (sleep_.controlled && island->control->steady(state_.time));
    if (mayRest && rests(*island))
      island->resting += model_.options.timestep;
    else
      island->resting = 0.0;
    if (island->resting < sleep_.time) continue;
    fallAsleep(*island);
    changed = true;
  }
  if (changed) refreshLists();
}

void Islands::collectStats() {
  islandStats_.islands = active_;
  islandStats_.awake = static_cast<int>(awake_.size());
  for (const Island* island : awake_) {
    islandStats_.controlled += island->controlled;
    stats_.add(island->data.stats);
  }
}

}  // namespace softgauss

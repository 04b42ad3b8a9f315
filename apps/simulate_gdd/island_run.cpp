// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/island_run.hpp"

#include <algorithm>

namespace softgauss::app {

namespace {

/// Goals, if there are any, control islands.
IslandControls* controlsOf(const Model& model, gdd::GoalDirectedController& controller,
                           std::optional<gdd::GoalDirectedIslands>& controls) {
  if (controller.goals.empty()) return nullptr;
  return &controls.emplace(model, controller);
}

}  // namespace

IslandRun::IslandRun(const Model& model, const State& initial, const Sleep& sleep,
                     gdd::GoalDirectedController& controller)
    : model_(model),
      controller_(controller),
      contacts_(model),
      islands_(model, &contacts_, sleep, controlsOf(model, controller, controls_)) {
  islands_.setState(initial);
  outcomes_.on = true;
  outcomes_.fewestAwake = islands_.units().size();
}

void IslandRun::take(const Input& input, State& state, Data& data) {
  data.stats = islands_.stats();
  collectContacts(data.contacts.contacts);
  if (isRefused(data.stats.status)) return;
  data.forward.a = data.acceleration = islands_.acceleration();
  if (controls_)
    data.forces.tau = controller_.control;
  else if (input.tau.size() > 0)
    data.forces.tau = input.tau;
  else
    data.forces.tau.setZero();
  addServoForces(data.forces.tau);
  state = islands_.state();

  const IslandStats& stats = islands_.islandStats();
  ++outcomes_.steps;
  outcomes_.islands += stats.islands;
  outcomes_.awake += stats.awake;
  outcomes_.wakeups += stats.wakeups;
  outcomes_.most = std::max(outcomes_.most, stats.islands);
  outcomes_.fewestAwake = std::min(outcomes_.fewestAwake, stats.awake);
}

void IslandRun::addServoForces(VectorX& tau) {
  ofScene_.setZero(model_.nv);
  for (int unit = 0; unit < islands_.units().size(); ++unit) {
    const Islands::Island& island = islands_.islandOf(unit);
    if (island.units.front() != unit || island.data.constraints.servo.rowCount() == 0) continue;
    ofIsland_.setZero(island.part.model.nv);
    softgauss::addServoForces(island.data, ofIsland_);
    island.part.scatter(model_, ofIsland_, ofScene_);
  }
  tau += ofScene_;
}

void IslandRun::collectContacts(std::vector<Contact>& contacts) {
  contacts.clear();
  forces_.clear();
  const Islands::Island* last = nullptr;
  for (int unit = 0; unit < islands_.units().size(); ++unit) {
    const Islands::Island& island = islands_.islandOf(unit);
    if (&island == last || island.units.front() != unit) continue;
    last = &island;
    const auto whole = [&](int geometry) {
      return island.part.geometries[static_cast<std::size_t>(geometry)];
    };
    for (Contact c : island.data.contacts.contacts) {
      c.geometryA = whole(c.geometryA), c.geometryB = whole(c.geometryB);
      c.bodyA = model_.geometries[static_cast<std::size_t>(c.geometryA)].body;
      c.bodyB = model_.geometries[static_cast<std::size_t>(c.geometryB)].body;
      contacts.push_back(c);
    }
    forcesOf(island);
    forces_.insert(forces_.end(), some_.begin(), some_.end());
  }
}

/// Into some_, in the geometries of the model.
void IslandRun::forcesOf(const Islands::Island& island) {
  const auto kept = asleep_.find(island.units.front());
  if (kept != asleep_.end() && !island.awake) {
    some_ = kept->second;
    return;
  }
  if (kept != asleep_.end()) asleep_.erase(kept);
  contactForces(island.data, some_);
  for (Snapshot::ContactForce& f : some_) {
    f.geometryA = island.part.geometries[static_cast<std::size_t>(f.geometryA)];
    f.geometryB = island.part.geometries[static_cast<std::size_t>(f.geometryB)];
  }
}

/// The forces on what sleeps are those of its last solve, which no later process has.
void IslandRun::keepAsleep() {
  for (int unit = 0; unit < islands_.units().size(); ++unit) {
    const Islands::Island& island = islands_.islandOf(unit);
    if (island.awake || island.units.front() != unit) continue;
    forcesOf(island);
    asleep_[unit] = some_;
  }
}

bool IslandRun::controlledCones() const {
  return std::any_of(islands_.awake().begin(), islands_.awake().end(), [](const auto* island) {
    return island->controlled && !island->data.constraints.piecewiseQuadratic();
  });
}

double IslandRun::physicsViolation() {
  double worst = 0.0;
  for (Islands::Island* island : islands_.awake()) {
    if (island->part.model.nv == 0) continue;
    inverseDynamics(island->part.model, island->data.forward.a, island->data, scratch_);
    worst = std::max(worst, (scratch_ - island->data.forces.tau).cwiseAbs().maxCoeff());
  }
  return worst;
}

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#include "apps/live/keyframes.hpp"

#include <algorithm>

#include "softgauss/engine/model/followers.hpp"

namespace softgauss::live {

Keyframes::Keyframes(Named named, const gdd::GoalDirectedController& controller)
    : named_(std::move(named)) {
  for (const auto& goal : controller.goals) {
    if (VectorX* const q = goal->soughtPositions()) postures_.push_back(q);
    if (double* const place = goal->soughtPlace()) places_.push_back(place);
    if (auto* const balance = dynamic_cast<gdd::StandingBalance*>(goal.get()))
      balances_.push_back(balance);
  }
  start_ = now();
}

Keyframes::Sought Keyframes::now() const {
  Sought sought;
  for (const VectorX* q : postures_) sought.postures.push_back(*q);
  for (const double* place : places_) sought.places.emplace_back(place[0], place[1], place[2]);
  for (const gdd::StandingBalance* balance : balances_) sought.bases.push_back(balance->X_WBase);
  return sought;
}

void Keyframes::seek(const Sought& sought) {
  for (std::size_t i = 0; i < postures_.size(); ++i) *postures_[i] = sought.postures[i];
  for (std::size_t i = 0; i < places_.size(); ++i)
    std::copy_n(sought.places[i].data(), 3, places_[i]);
  for (std::size_t i = 0; i < balances_.size(); ++i) balances_[i]->X_WBase = sought.bases[i];
}

void Keyframes::store(int slot, const State& state) {
  slots_.at(static_cast<std::size_t>(slot - 1)) = Kept{state.q, state.v, now()};
}

bool Keyframes::recall(int slot, const Model& model, State& state) {
  const std::optional<Kept>& kept = slots_.at(static_cast<std::size_t>(slot - 1));
  if (!kept) return false;
  put(kept->q, kept->v, model, state);
  seek(kept->sought);
  return true;
}

void Keyframes::goTo(const std::string& name, const Model& model, State& state) {
  for (const auto& [called, q] : named_) {
    if (called != name) continue;
    put(q, VectorX::Zero(model.nv), model, state);
    hold(model, q);
    return;
  }
}

void Keyframes::put(const VectorX& q, const VectorX& v, const Model& model, State& state) {
  state.q = q;
  state.v = v;
  // What the last step has found is of another place.
  state.warmstart = State(model).warmstart;
  state.forgetLastStep();
}

void Keyframes::hold(const Model& model, const VectorX& q) {
  for (VectorX* posture : postures_) *posture = q;
  for (gdd::StandingBalance* balance : balances_) {
    const int at = model.bodies[static_cast<std::size_t>(balance->base)].q;
    const Quaternion turn(q[at + 3], q[at + 4], q[at + 5], q[at + 6]);
    balance->X_WBase = {turn.normalized().toRotationMatrix(), q.segment<3>(at)};
  }
}

bool Keyframes::seek(const Model& model, int body, double position) {
  for (VectorX* posture : postures_) {
    (*posture)[model.bodies[static_cast<std::size_t>(body)].q] = position;
    placeFollowers(model, {body}, *posture);
  }
  return !postures_.empty();
}

const VectorX* Keyframes::sought() const { return postures_.empty() ? nullptr : postures_.front(); }

std::vector<std::string> Keyframes::names() const {
  std::vector<std::string> names;
  for (const auto& [name, q] : named_) names.push_back(name);
  return names;
}

std::vector<int> Keyframes::stored() const {
  std::vector<int> stored;
  for (int slot = 1; slot <= kSlots; ++slot)
    if (slots_[static_cast<std::size_t>(slot - 1)]) stored.push_back(slot);
  return stored;
}

}  // namespace softgauss::live

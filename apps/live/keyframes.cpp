// SPDX-License-Identifier: Apache-2.0
#include "apps/live/keyframes.hpp"

#include <algorithm>

#include "softgauss/engine/model/followers.hpp"

namespace softgauss::live {

Keyframes::Keyframes(Named named, const gdd::GoalDirectedController& controller)
    : named_(std::move(named)) {
  for (const auto& goal : controller.goals) {
    if (auto* posture = dynamic_cast<gdd::Posture*>(goal.get()))
      postures_.emplace_back(posture, posture->q);
    if (auto* balance = dynamic_cast<gdd::StandingBalance*>(goal.get()))
      bases_.emplace_back(balance, balance->X_WBase);
  }
}

void Keyframes::store(int slot, const State& state) {
  Kept kept{state.q, state.v, {}, {}};
  for (const auto& [posture, start] : postures_) kept.postures.push_back(posture->q);
  for (const auto& [balance, start] : bases_) kept.bases.push_back(balance->X_WBase);
  slots_.at(static_cast<std::size_t>(slot - 1)) = std::move(kept);
}

bool Keyframes::recall(int slot, const Model& model, State& state) {
  const std::optional<Kept>& kept = slots_.at(static_cast<std::size_t>(slot - 1));
  if (!kept) return false;
  put(*kept, model, state);
  for (std::size_t i = 0; i < postures_.size(); ++i) postures_[i].first->q = kept->postures[i];
  for (std::size_t i = 0; i < bases_.size(); ++i) bases_[i].first->X_WBase = kept->bases[i];
  return true;
}

void Keyframes::goTo(const std::string& name, const Model& model, State& state) {
  for (const auto& [called, q] : named_) {
    if (called != name) continue;
    put({q, VectorX::Zero(model.nv), {}, {}}, model, state);
    hold(model, q);
    return;
  }
}

void Keyframes::put(const Kept& kept, const Model& model, State& state) {
  state.q = kept.q;
  state.v = kept.v;
  // What the last step has found is of another place.
  state.warmstart = State(model).warmstart;
  state.forgetLastStep();
}

void Keyframes::hold(const Model& model, const VectorX& q) {
  for (const auto& [posture, start] : postures_) posture->q = q;
  for (const auto& [balance, start] : bases_) {
    const int at = model.bodies[static_cast<std::size_t>(balance->base)].q;
    const Quaternion turn(q[at + 3], q[at + 4], q[at + 5], q[at + 6]);
    balance->X_WBase = {turn.normalized().toRotationMatrix(), q.segment<3>(at)};
  }
}

void Keyframes::reset() {
  for (const auto& [posture, start] : postures_) posture->q = start;
  for (const auto& [balance, start] : bases_) balance->X_WBase = start;
}

bool Keyframes::seek(const Model& model, int body, double position) {
  for (const auto& [posture, start] : postures_) {
    posture->q[model.bodies[static_cast<std::size_t>(body)].q] = position;
    placeFollowers(model, {body}, posture->q);
  }
  return !postures_.empty();
}

const VectorX* Keyframes::sought() const {
  return postures_.empty() ? nullptr : &postures_.front().first->q;
}

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

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// States to which a run can be put: some by name, and nine that are stored on the way.
///
/// A run that is put into a state by name is at rest in it, and what holds a posture, or a robot
/// upright, holds that state from then on; one that is put into a stored state moves as it did, and
/// goals seek what they sought then. Its time goes on.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "softgauss/gdd/goal_directed_step.hpp"
#include "softgauss/gdd/goals/standing_balance.hpp"

namespace softgauss::live {

class Keyframes {
 public:
  static constexpr int kSlots = 9;
  using Named = std::vector<std::pair<std::string, VectorX>>;  ///< q (nq)

  Keyframes(Named named, const gdd::GoalDirectedController& controller);

  void store(int slot, const State& state);
  /// Whether there is a state to put the run into.
  bool recall(int slot, const Model& model, State& state);
  void goTo(const std::string& name, const Model& model, State& state);
  /// Goals seek again what they sought at the start.
  void reset() { seek(start_); }
  /// Goals that seek a configuration seek a place for a joint, by the body it carries; whether
  /// there is one.
  bool seek(const Model& model, int body, double position);
  /// What the first of these seeks (nq); null where there is none.
  const VectorX* sought() const;

  std::vector<std::string> names() const;
  std::vector<int> stored() const;  ///< slots, from 1 on

 private:
  struct Sought {
    std::vector<VectorX> postures;
    std::vector<Vector3> places;
    std::vector<Transform> bases;  ///< where balances hold them
  };
  struct Kept {
    VectorX q, v;
    Sought sought;
  };
  static void put(const VectorX& q, const VectorX& v, const Model& model, State& state);
  /// Postures and balances seek a configuration.
  void hold(const Model& model, const VectorX& q);
  Sought now() const;
  void seek(const Sought& sought);

  Named named_;
  // Of goals that seek such a thing, what they seek.
  std::vector<VectorX*> postures_;
  std::vector<double*> places_;
  std::vector<gdd::StandingBalance*> balances_;
  Sought start_;
  std::array<std::optional<Kept>, kSlots> slots_;
};

}  // namespace softgauss::live

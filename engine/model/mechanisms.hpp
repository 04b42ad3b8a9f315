// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The mechanisms beside the bare step: each can be left out alone, Options::mechanisms, and
/// `stability_report --ablate` tells which hard cases fail without it. `--compatibility mujoco`,
/// by its own integrator, has none of them.

#include <array>
#include <iterator>
#include <optional>
#include <string_view>

#include "engine/core/enum_set.hpp"

namespace softgauss {

enum class Mechanism : std::uint8_t {
  prediction,
  parts,
  freeTrees,
  endOfStepTies,
  contactHorizon,
  contactTurning,
  stepBounds,
  carriedLoad,
  sticking,
  swingDamping
};

struct MechanismName {
  Mechanism mechanism;
  std::string_view name;         ///< as in --without, scenes and the summary
  std::string_view description;  ///< one line for --explain and the ablation table
};

inline constexpr MechanismName kMechanismNames[] = {
    {Mechanism::prediction, "prediction",
     "Coriolis forces and J̇ v at the velocity of mid-step that the last acceleration predicts"},
    {Mechanism::parts, "parts", "steps in parts where bodies turn far"},
    {Mechanism::freeTrees, "free_trees", "trees that turn far by themselves are followed"},
    {Mechanism::endOfStepTies, "end_of_step_ties", "connections and welds hold at the step's end"},
    {Mechanism::contactHorizon, "contact_horizon",
     "contacts take their velocity while their normal and levers hold"},
    {Mechanism::contactTurning, "contact_turning", "contacts know how their place moves, J̇ v"},
    {Mechanism::stepBounds, "step_bounds", "softness that a step can follow"},
    {Mechanism::carriedLoad, "carried_load", "softness by the load that a row carries"},
    {Mechanism::sticking, "sticking", "friction hardens where it sticks"},
    {Mechanism::swingDamping, "swing_damping", "light bodies between taut connections are held"},
};

using MechanismSet = EnumSet<Mechanism>;

/// How often each mechanism has acted: on contacts, joint limits, equality constraints, trees,
/// bodies or parts of a step.
class MechanismCounts {
 public:
  int& operator[](Mechanism m) { return counts_[static_cast<std::size_t>(m)]; }
  int operator[](Mechanism m) const { return counts_[static_cast<std::size_t>(m)]; }
  void add(const MechanismCounts& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
  }

 private:
  std::array<int, std::size(kMechanismNames)> counts_{};
};

/// The mechanism of that name, or nothing.
constexpr std::optional<Mechanism> mechanismFromName(std::string_view name) {
  for (const MechanismName& m : kMechanismNames)
    if (m.name == name) return m.mechanism;
  return std::nullopt;
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The mechanisms beside the bare step: each can be left out alone, Options::mechanisms, and
/// `stability_report --ablate` tells which hard cases fail without it. `--compatibility mujoco`,
/// by its own integrator, has none of them.

#include <array>
#include <iterator>
#include <optional>
#include <string_view>

#include "softgauss/engine/core/enum_set.hpp"

namespace softgauss {

enum class Mechanism : std::uint8_t {
  midpointVelocity,
  substepping,
  treeSubstepping,
  nearRigid,
  contactBiasAcceleration,
  supportedMass,
  stiction,
  slipCorrection,
  geometricStiffness
};

struct MechanismName {
  Mechanism mechanism;
  std::string_view name;         ///< as in --without, scenes and the summary
  std::string_view description;  ///< one line for --explain and the ablation table
};

inline constexpr MechanismName kMechanismNames[] = {
    {Mechanism::midpointVelocity, "midpoint_velocity",
     "Coriolis forces and J̇ v at the mid-step velocity, predicted from the last acceleration"},
    {Mechanism::substepping, "substepping",
     "the step is divided into substeps where bodies rotate far"},
    {Mechanism::treeSubstepping, "tree_substepping",
     "trees that move freely are integrated in substeps of their own"},
    {Mechanism::nearRigid, "near_rigid",
     "contacts, limits and joint friction without a stiffness hardly give, and act before they "
     "touch"},
    {Mechanism::contactBiasAcceleration, "contact_bias_acceleration",
     "contacts include the bias acceleration J̇ v of the contact point"},
    {Mechanism::supportedMass, "supported_mass",
     "constraints are regularised by the mass that they support"},
    {Mechanism::stiction, "stiction", "friction is regularised less where it sticks"},
    {Mechanism::slipCorrection, "slip_correction",
     "sliding contacts are pressed by their load and held back along their slip"},
    {Mechanism::geometricStiffness, "geometric_stiffness",
     "the geometric stiffness of taut connections stabilises light bodies"},
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

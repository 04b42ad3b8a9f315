// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Names of the effects that a scene may call for, and sets of them.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace softgauss {

enum class Effect : std::uint8_t {
  gravity,
  coriolis,
  damping,
  spring,
  armature,
  actuation,
  externalWrench,
  jointLimit,
  dryFriction,
  equality,
  selfCollision,
  groundContact,
  objectContact,
  torsionalFriction,
  rollingFriction
};

struct EffectName {
  Effect effect;
  std::string_view name;         ///< as in --effects and the summary
  std::string_view description;  ///< one line for --explain
};

inline constexpr EffectName kEffectNames[] = {
    {Effect::gravity, "gravity", "weight of every body"},
    {Effect::coriolis, "coriolis", "velocity-dependent inertial forces"},
    {Effect::damping, "damping", "joint damping, implicit in the step"},
    {Effect::spring, "spring", "springs of joints"},
    {Effect::armature, "armature", "rotor inertia on the diagonal of M"},
    {Effect::actuation, "actuation", "controls on actuated joints"},
    {Effect::externalWrench, "external_wrench", "forces and moments applied from outside"},
    {Effect::jointLimit, "joint_limit", "soft joint limits"},
    {Effect::dryFriction, "dry_friction", "Coulomb friction of joints"},
    {Effect::equality, "equality", "connections, welds, coupled joints"},
    {Effect::selfCollision, "self_collision", "contacts between bodies of one robot"},
    {Effect::groundContact, "ground_contact", "contacts with shapes fixed to the world"},
    {Effect::objectContact, "object_contact", "contacts between different robots"},
    {Effect::torsionalFriction, "torsional_friction", "moment about the normal of a contact"},
    {Effect::rollingFriction, "rolling_friction", "moment about the tangents of a contact"},
};

/// A set of effects.
class EffectSet {
 public:
  static constexpr EffectSet all() { return EffectSet(~0u); }
  static constexpr EffectSet none() { return EffectSet(0u); }
  constexpr bool has(Effect e) const { return (bits_ >> static_cast<unsigned>(e)) & 1u; }
  constexpr void insert(Effect e) { bits_ |= 1u << static_cast<unsigned>(e); }
  constexpr void remove(Effect e) { bits_ &= ~(1u << static_cast<unsigned>(e)); }
  constexpr bool operator==(const EffectSet&) const = default;

 private:
  explicit constexpr EffectSet(std::uint32_t bits) : bits_(bits) {}
  std::uint32_t bits_;
};

/// The effect of that name, or nothing.
inline std::optional<Effect> effectFromName(std::string_view name) {
  for (const EffectName& e : kEffectNames)
    if (e.name == name) return e.effect;
  return std::nullopt;
}

inline std::string_view effectName(Effect effect) {
  return kEffectNames[static_cast<int>(effect)].name;
}

}  // namespace softgauss

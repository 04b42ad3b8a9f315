// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Names of the effects that a scene may call for, and sets of them.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "softgauss/engine/core/enum_set.hpp"

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

using EffectSet = EnumSet<Effect>;

/// The effect of that name, or nothing.
constexpr std::optional<Effect> effectFromName(std::string_view name) {
  for (const EffectName& e : kEffectNames)
    if (e.name == name) return e.effect;
  return std::nullopt;
}

inline std::string_view effectName(Effect effect) {
  return kEffectNames[static_cast<int>(effect)].name;
}

/// All effects but those of a list such as "damping,spring". A name that is none is no constant
/// expression, and so an error where this is one.
constexpr EffectSet allEffectsBut(std::string_view list) {
  EffectSet set = EffectSet::all();
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(','), list.size());
    set.remove(effectFromName(list.substr(0, end)).value());
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return set;
}

#ifndef SOFTGAUSS_WITHOUT_EFFECTS
#define SOFTGAUSS_WITHOUT_EFFECTS ""
#endif
/// The effects that this build of the engine has: all, unless CMake's SOFTGAUSS_WITHOUT_EFFECTS
/// names some. The code of the others is not in the step.
inline constexpr EffectSet kBuiltEffects = allEffectsBut(SOFTGAUSS_WITHOUT_EFFECTS);

}  // namespace softgauss

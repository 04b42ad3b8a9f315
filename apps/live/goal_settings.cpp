// SPDX-License-Identifier: Apache-2.0
#include "apps/live/goal_settings.hpp"

#include <type_traits>

#include "apps/live/drag.hpp"
#include "softgauss/gdd/gdd.hpp"

namespace softgauss::live {
namespace {

/// The unit of a weight, as docs/reference/goals.md has it.
template <class T>
const char* weightUnitOf([[maybe_unused]] const T& goal) {
  using namespace gdd;
  if constexpr (requires { goal.metric == LinkMetric::euclidean; })
    return goal.metric == LinkMetric::euclidean ? "kg" : "";
  else if constexpr (std::is_same_v<T, Hold> || std::is_same_v<T, KeepClear> ||
                     std::is_same_v<T, CenterOfMass> || std::is_same_v<T, CapturePoint>)
    return "kg";
  else if constexpr (std::is_same_v<T, LookAt>)
    return "kg m²";
  else if constexpr (std::is_same_v<T, ContactForce>)
    return "1/kg";
  else if constexpr (std::is_same_v<T, CenterOfPressure>)
    return "1/(kg m²)";
  else
    return "";
}

/// Of a goal that is a T, those members that T has.
template <class T>
bool read(gdd::Goal& goal, GoalSettings& out) {
  auto* found = dynamic_cast<T*>(&goal);
  if (!found) return false;
  out.weight = &found->weight;
  out.weightUnit = weightUnitOf(*found);
  if constexpr (requires { found->defaultWeight; })
    out.weightIsDefault = found->defaultWeight.isAt(found->weight);
  if constexpr (requires { found->stiffness; }) out.stiffness = &found->stiffness;
  if constexpr (requires { found->damping; }) out.damping = &found->damping;
  if constexpr (requires { found->rate; }) out.rate = &found->rate;
  return true;
}

template <class... T>
GoalSettings firstOf(gdd::Goal& goal) {
  GoalSettings out;
  (read<T>(goal, out) || ...);
  return out;
}

}  // namespace

GoalSettings settingsOf(gdd::Goal& goal) {
  if (auto* drag = dynamic_cast<Drag*>(&goal)) return settingsOf(drag->reach);
  return firstOf<gdd::Reach, gdd::Posture, gdd::VirtualDamping, gdd::Hold, gdd::JointPosture,
                 gdd::JointAcceleration, gdd::JointVelocity, gdd::CenterOfMass, gdd::CapturePoint,
                 gdd::Effort, gdd::LinkAcceleration, gdd::LookAt, gdd::KeepClear, gdd::ContactForce,
                 gdd::CenterOfPressure>(goal);
}

}  // namespace softgauss::live

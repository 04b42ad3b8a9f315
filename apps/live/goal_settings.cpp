// SPDX-License-Identifier: Apache-2.0
#include "apps/live/goal_settings.hpp"

#include "apps/live/drag.hpp"
#include "softgauss/gdd/gdd.hpp"

namespace softgauss::live {
namespace {

/// Of a goal that is a T, those members that T has.
template <class T>
bool read(gdd::Goal& goal, GoalSettings& out) {
  auto* found = dynamic_cast<T*>(&goal);
  if (!found) return false;
  if constexpr (requires { found->weight; }) out.weight = &found->weight;
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
                 gdd::JointAcceleration, gdd::CenterOfMass, gdd::CapturePoint, gdd::Effort,
                 gdd::LinkAcceleration>(goal);
}

}  // namespace softgauss::live

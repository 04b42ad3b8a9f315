// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/held_back.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/io/names.hpp"

namespace softgauss::io {
namespace {

/// A goal's name; of a regulariser, which nobody has asked for, that it is one.
std::string goalText(const gdd::GoalBalance& balance, int i) {
  return balance.goal(i).isRegulariser ? "default " + balance.goalName(i) : balance.goalName(i);
}

/// The name of what opposes goal `goal`.
std::string nameOf(const Model& model, const gdd::ControlLimits& limits,
                   const gdd::GoalBalance& balance, const gdd::Opponent& o, int goal) {
  using Kind = gdd::Opponent::Kind;
  const auto joint = [&](int dof) {
    return nameText(model.jointNames[idx(model.dofs[idx(dof)].body)]);
  };
  const auto link = [&](int geometry) {
    const Geometry& g = model.geometries[idx(geometry)];
    return nameText(g.link == "world" ? g.name : g.link);
  };
  switch (o.kind) {
    case Kind::goal:
      return o.index == goal ? "its other joints" : goalText(balance, o.index);
    case Kind::controlCost:
      return "control cost";
    case Kind::controlLimit:
      if (limits.transmission)
        for (int k = 0; const gdd::Actuator& a : limits.transmission->actuators())
          if (limits.transmission->coordinateOf(k++) == o.index)
            return "limit of " + nameText(a.name);
      return "torque limit of " + joint(o.index);
    case Kind::range:
      return "range of " + joint(o.index);
    case Kind::velocityLimit:
      return "velocity limit of " + joint(o.index);
    case Kind::contact: {
      const bool fixedFirst = model.geometries[idx(o.index)].body == 0;
      return fmt::format("contact of {} with {}", link(fixedFirst ? o.other : o.index),
                         link(fixedFirst ? o.index : o.other));
    }
    case Kind::dryFriction:
      return "dry friction of " + joint(o.index);
    case Kind::servo:
      return "servo of " + joint(o.index);
    case Kind::equality:
      return "what joins links besides joints";
  }
  return {};
}

}  // namespace

HeldBack heldBack(const Model& model, const gdd::ControlLimits& limits, gdd::GoalBalance& balance,
                  int i, int dof) {
  const gdd::Opposition opposition = balance.against(i, dof);
  HeldBack result;
  result.held = opposition.opponents.empty() ? 1.0 : opposition.held;
  if (opposition.singular) result.causes.push_back({"singular configuration", 1.0});
  result.singular = opposition.singular;
  for (const gdd::Opponent& o : opposition.opponents) {
    const std::string name = nameOf(model, limits, balance, o, i);
    if (o.kind == gdd::Opponent::Kind::controlCost ||
        (o.kind == gdd::Opponent::Kind::goal && o.index != i))
      result.weighed += o.share;
    const auto same = std::find_if(result.causes.begin(), result.causes.end(),
                                   [&](const auto& cause) { return cause.what == name; });
    if (same == result.causes.end())
      result.causes.push_back({name, o.share});
    else
      same->share += o.share;
  }
  std::stable_sort(result.causes.begin(), result.causes.end(),
                   [](const auto& a, const auto& b) { return a.share > b.share; });
  return result;
}

}  // namespace softgauss::io

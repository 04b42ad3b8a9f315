// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/held_back.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/simulate_gdd/names.hpp"
#include "apps/simulate_gdd/verdict.hpp"

namespace softgauss::app {
namespace {

constexpr std::size_t kMostCauses = 4;  // that are told by name
constexpr double kToldShare = 0.005;    // less is rounded to nothing

/// A goal's name; of a regulariser, which nobody has asked for, that it is one.
std::string goalText(const gdd::GoalBalance& balance, int i) {
  return balance.goal(i).isRegulariser ? "default " + balance.goalName(i) : balance.goalName(i);
}

}  // namespace

std::string HeldBack::nameOf(const gdd::Opponent& o, int goal) const {
  using Kind = gdd::Opponent::Kind;
  const auto joint = [&](int dof) {
    return nameText(model_.jointNames[model_.dofs[idx(dof)].body]);
  };
  const auto link = [&](int geometry) {
    const Geometry& g = model_.geometries[idx(geometry)];
    return nameText(g.link == "world" ? g.name : g.link);
  };
  switch (o.kind) {
    case Kind::goal:
      return o.index == goal ? "its other joints" : goalText(*balance_, o.index);
    case Kind::controlCost:
      return "control cost";
    case Kind::controlLimit:
      if (controller_.limits.transmission)
        for (int k = 0; const gdd::Actuator& a : controller_.limits.transmission->actuators())
          if (controller_.limits.transmission->coordinateOf(k++) == o.index)
            return "limit of " + nameText(a.name);
      return "torque limit of " + joint(o.index);
    case Kind::range:
      return "range of " + joint(o.index);
    case Kind::velocityLimit:
      return "velocity limit of " + joint(o.index);
    case Kind::contact: {
      const bool fixedFirst = model_.geometries[idx(o.index)].body == 0;
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

HeldGoal HeldBack::of(const GoalRecord::Track& track, const SeenStep& step) {
  State state = step.after;
  if (!track.goal->actsAt(state.time)) state.time = std::nextafter(track.goal->endTime, 0.0);
  if (!track.goal->actsAt(state.time)) return {};
  if (!balance_) balance_.emplace(model_, controller_);
  if (solvedAt_ != state.time) solved_ = balance_->solve(step.input, state, &step.source);
  solvedAt_ = state.time;
  const int goal = solved_ ? balance_->find(*track.goal, track.outcome.name) : -1;
  if (goal < 0) return {};
  const gdd::Opposition opposition = balance_->against(goal, track.last.dof);
  HeldGoal result;
  result.held = opposition.opponents.empty() ? 1.0 : opposition.held;
  if (opposition.singular) result.causes.push_back({"singular configuration", 1.0});
  result.singular = opposition.singular;
  for (const gdd::Opponent& o : opposition.opponents) {
    const std::string name = nameOf(o, goal);
    if (o.kind == gdd::Opponent::Kind::controlCost ||
        (o.kind == gdd::Opponent::Kind::goal && o.index != goal))
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

std::string HeldBack::text(const std::vector<io::GoalOutcome::Cause>& causes) {
  std::string text;
  double others = 0.0;
  for (std::size_t i = 0; i < causes.size(); ++i) {
    if (i >= kMostCauses)
      others += causes[i].share;
    else if (causes[i].share >= kToldShare)
      text += fmt::format("{}{} {:.0f} %", text.empty() ? "" : ", ", causes[i].what,
                          100.0 * causes[i].share);
  }
  if (others >= kToldShare) text += fmt::format(", others {:.0f} %", 100.0 * others);
  return text;
}

}  // namespace softgauss::app

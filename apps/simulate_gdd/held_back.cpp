// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/held_back.hpp"

#include <fmt/format.h>

#include <cmath>

#include "apps/simulate_gdd/verdict.hpp"

namespace softgauss::app {
namespace {

constexpr std::size_t kMostCauses = 4;  // that are told by name
constexpr double kToldShare = 0.005;    // less is rounded to nothing

}  // namespace

io::HeldBack HeldBack::of(const GoalRecord::Track& track, const SeenStep& step) {
  State state = step.after;
  if (!track.goal->actsAt(state.time)) state.time = std::nextafter(track.goal->endTime, 0.0);
  if (!track.goal->actsAt(state.time)) return {};
  if (!balance_) balance_.emplace(model_, controller_);
  if (solvedAt_ != state.time) solved_ = balance_->solve(step.input, state, &step.source);
  solvedAt_ = state.time;
  const int goal = solved_ ? balance_->find(*track.goal, track.outcome.name) : -1;
  if (goal < 0) return {};
  return io::heldBack(model_, controller_.limits, *balance_, goal, track.last.dof);
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

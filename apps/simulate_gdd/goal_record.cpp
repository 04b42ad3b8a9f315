// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/goal_record.hpp"

#include <fmt/format.h>

#include <cstring>
#include <limits>

#include "apps/live/drag.hpp"

namespace softgauss::app {

GoalRecord::GoalRecord(const std::vector<std::unique_ptr<gdd::Goal>>& goals,
                       const gdd::GoalContext& start)
    : dofs_(start.model.nv) {
  const std::vector<std::string> names = gdd::distinctNames(goals);
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const auto& goal = goals[i];
    if (goal->isRegulariser) continue;
    figures_.clear();
    goal->errors(start, {}, figures_);
    // A goal without a figure now, such as a centre of pressure in the air, may have one later.
    if (figures_.empty() && goal->hasLaterErrors()) figures_.emplace_back();
    for (const gdd::GoalError& figure : figures_) {
      Track track{goal.get(), {}, figure};
      track.outcome.name = *figure.what ? fmt::format("{} ({})", names[i], figure.what) : names[i];
      track.outcome.unit = figure.unit;
      track.outcome.yields = figure.yields;
      track.outcome.began = false;
      tracks_.push_back(std::move(track));
    }
  }
  errors_ = VectorX::Constant(static_cast<Eigen::Index>(tracks_.size()),
                              std::numeric_limits<double>::quiet_NaN());
}

bool GoalRecord::Track::wasNotAsked() const {
  return !outcome.began && dynamic_cast<const live::Drag*>(goal) != nullptr;
}

void GoalRecord::see(Track& track, const gdd::GoalError& figure, double time, bool acts) {
  io::GoalOutcome& o = track.outcome;
  track.last = figure;
  if (!acts) return;
  if (!o.began) {
    o.initialError = o.bestError = figure.value;
    o.bestTime = time;
    o.began = true;
  }
  o.finalError = figure.value;
  o.judgedAt = time;
  o.met = figure.met;
  if (figure.value < o.bestError) o.bestError = figure.value, o.bestTime = time;
  if (!(figure.value <= figure.met))
    o.metSince.reset();
  else if (!o.metSince)
    o.metSince = time;
}

std::vector<GoalRecord::Track*> GoalRecord::observe(const gdd::GoalContext& context,
                                                    const gdd::ContactForces& contacts) {
  std::vector<Track*> ended;
  errors_.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t first = 0, end = 0; first < tracks_.size(); first = end) {
    const gdd::Goal& goal = *tracks_[first].goal;
    while (end < tracks_.size() && tracks_[end].goal == &goal) ++end;
    const double time = context.state.time;
    const bool acts = goal.actsAt(time);
    figures_.clear();
    goal.errors(context, contacts, figures_);
    for (std::size_t i = first; i < end; ++i) {
      Track& track = tracks_[i];
      for (const gdd::GoalError& figure : figures_)
        if (std::strcmp(figure.what, track.last.what) == 0) {
          errors_[static_cast<Eigen::Index>(i)] = figure.value;
          see(track, figure, time, acts);
        }
      if (track.acts && !acts) ended.push_back(&track);
      track.acts = acts;
    }
  }
  return ended;
}

std::vector<std::string> GoalRecord::columns() const {
  std::vector<std::string> names;
  for (const Track& track : tracks_)
    names.push_back(fmt::format("{} [{}]", track.outcome.name, track.outcome.unit));
  return names;
}

}  // namespace softgauss::app

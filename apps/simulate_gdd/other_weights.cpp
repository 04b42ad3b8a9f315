// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/other_weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "apps/live/goal_settings.hpp"
#include "softgauss/gdd/goals/reach.hpp"
#include "softgauss/io/figure_text.hpp"

namespace softgauss::app {
namespace {

constexpr double kHeldByWeights = 0.5;  // with less a weight is not what to change
constexpr double kWorthTelling = 0.5;   // of what is left
constexpr int kMostGoals = 3;           // a trial takes seconds of simulated time
constexpr int kMostDofs = 200;

/// The weight that makes up this figure of the goal; null where none does alone.
double* weightOf(gdd::Goal& goal, const char* figure) {
  auto* reach = dynamic_cast<gdd::Reach*>(&goal);
  if (reach && std::strcmp(figure, "orientation") == 0) return &reach->rotationWeight;
  return live::settingsOf(goal).weight;
}

/// 1e5, as a person types it.
std::string weightText(double weight) {
  const double power = std::round(std::log10(weight));
  return std::abs(power) >= 4.0 ? fmt::format("1e{:.0f}", power) : fmt::format("{:.3g}", weight);
}

}  // namespace

std::optional<double> OtherWeights::leaves(const GoalRecord::Track& track, double& weight,
                                           double tried, const SeenStep& end) {
  if (!trial_) trial_.emplace(model_, controller_);
  Standing standing = standing_;
  const Data* last = nullptr;
  double time = end.after.time;
  const auto watch = [&](const Data& data, const gdd::ContactForces& contacts, double since) {
    time = end.after.time + since;
    standing.observe(data.kinematics, contacts, time, end.length);
    last = &data;
  };
  const std::optional<double> left = trial_->leaves(*track.goal, track.last, weight, tried,
                                                    end.input, end.after, &end.source, watch);
  if (!left || !last) return std::nullopt;
  for (const StandingOutcome& o : standing.outcomes(last->kinematics, time))
    if (o.fell || o.falling || o.inAir) return std::nullopt;
  return left;
}

std::optional<io::GoalOutcome::OtherWeight> OtherWeights::find(const GoalRecord::Track& track,
                                                               double& weight,
                                                               const SeenStep& end) {
  const io::GoalOutcome& o = track.outcome;
  const double most = std::max(o.initialError, o.finalError), wanted = 0.5 * o.met;
  const double largest = gdd::OtherWeight::kMostRaised * weight;
  double tried = gdd::OtherWeight::toTry(weight, o.finalError, most, wanted);
  std::optional<io::GoalOutcome::OtherWeight> best;
  for (int i = 0; i < 2; ++i) {
    const std::optional<double> left = leaves(track, weight, tried, end);
    if (left && *left <= kWorthTelling * o.finalError && (!best || *left < best->error))
      best = {tried, *left};
    if (!left || *left <= o.met) break;
    const double next = gdd::OtherWeight::toTry(tried, *left, most, wanted);
    if (!(next > tried) || next > largest) break;
    tried = next;
  }
  return best;
}

void OtherWeights::tell(std::vector<GoalRecord::Track>& tracks, const SeenStep& end) {
  if (model_.nv > kMostDofs) return;
  int goals = 0;
  for (GoalRecord::Track& track : tracks) {
    io::GoalOutcome& o = track.outcome;
    if (o.isMet() || o.yields || !(track.weighed > kHeldByWeights) ||
        !track.goal->actsAt(end.after.time) || !track.goal->steadyAt(end.after.time))
      continue;
    const auto owner = std::find_if(controller_.goals.begin(), controller_.goals.end(),
                                    [&](const auto& goal) { return goal.get() == track.goal; });
    if (owner == controller_.goals.end()) continue;
    double* weight = weightOf(**owner, track.last.what);
    if (!weight || !(*weight > 0.0) || goals++ == kMostGoals) continue;
    o.otherWeight = find(track, *weight, end);
    if (o.otherWeight)
      o.reason += fmt::format("; a weight of {} would leave {}", weightText(o.otherWeight->weight),
                              io::figureText(o.otherWeight->error, o.unit));
  }
}

}  // namespace softgauss::app

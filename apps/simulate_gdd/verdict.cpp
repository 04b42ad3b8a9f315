// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/simulate_gdd/names.hpp"
#include "apps/simulate_gdd/other_weights.hpp"
#include "apps/simulate_gdd/reach_limit.hpp"
#include "softgauss/gdd/goals/reach.hpp"
#include "softgauss/io/figure_text.hpp"

namespace softgauss::app {
namespace {

using io::figureText;
using io::lengthText;

constexpr double kMoving = 0.05;      // [m/s or rad/s] faster is still on its way
constexpr double kHeld = 0.5;         // of a goal's pull: with less it is followed
constexpr double kToldHeight = 1e-3;  // [m]
constexpr double kDegrees = 180.0 / M_PI;
const char* const kRanges = "ranges of its joints";

std::vector<char> boltedTrees(const gdd::GoalContext& start) {
  std::vector<char> bolted;
  for (int t = 0; t < static_cast<int>(start.model.trees.size()); ++t)
    bolted.push_back(start.model.floats(t) && looksBolted(start.model, start.data.kinematics, t));
  return bolted;
}

/// Where single ranges hold, they have the share of those that are only known together.
void nameRanges(std::vector<io::GoalOutcome::Cause>& causes) {
  double single = 0.0, together = 0.0;
  const auto isSingle = [](const io::GoalOutcome::Cause& c) {
    return c.what.starts_with("range of ");
  };
  for (const io::GoalOutcome::Cause& c : causes) {
    if (isSingle(c)) single += c.share;
    if (c.what == kRanges) together += c.share;
  }
  if (single == 0.0 || together == 0.0) return;
  std::erase_if(causes, [](const io::GoalOutcome::Cause& c) { return c.what == kRanges; });
  for (io::GoalOutcome::Cause& c : causes)
    if (isSingle(c)) c.share *= (single + together) / single;
}

bool reaches(const gdd::GoalDirectedController& controller) {
  return std::any_of(controller.goals.begin(), controller.goals.end(), [](const auto& goal) {
    return dynamic_cast<const gdd::Reach*>(goal.get()) != nullptr;
  });
}

}  // namespace

Verdict::Verdict(gdd::GoalDirectedController& controller, const gdd::GoalContext& start,
                 bool passive, const BaseNotes& bases)
    : model_(start.model),
      controller_(controller),
      baseOrigin_(bases.origin),
      straightKnees_(reaches(controller) ? bases.straightKnees : ""),
      bolted_(boltedTrees(start)),
      heldBack_(start.model, controller),
      goals_(controller.goals, start),
      joints_(start.model, controller.limits),
      standing_(start.model, start.data.kinematics),
      oddities_(start.model, passive) {}

std::vector<std::string> Verdict::observe(const SeenStep& step) {
  const io::StepRecord& r = step.record;
  at_.q = r.q;
  at_.v = r.v;
  at_.time = r.time;
  for (GoalRecord::Track* track : goals_.observe({model_, at_, step.data}, step.contacts))
    if (!track->outcome.isMet()) findReason(*track, step);
  heldBack_.forget();
  joints_.observe(r.u, controller_.commands, step.after, step.length);
  standing_.observe(step.data.kinematics, step.contacts, r.time, step.length);
  return oddities_.observe(at_, r.time, r.energy, r.kineticEnergy);
}

void Verdict::finish(const SeenStep& end) {
  const io::StepRecord& r = end.record;
  at_.q = r.q;
  at_.v = r.v;
  at_.time = r.time;
  stood_ = standing_.outcomes(end.data.kinematics, r.time);
  oddities_.observe(at_, r.time, r.energy, r.kineticEnergy);
  goals_.observe({model_, at_, end.data}, end.contacts);
  for (GoalRecord::Track& track : goals_.tracks()) {
    io::GoalOutcome& o = track.outcome;
    if (!o.began)
      o.reason = track.goal->startTime > r.time
                     ? fmt::format("it begins at {:.4g} s, after the end", track.goal->startTime)
                     : "no contact that it counts";
    else if (!o.isMet() && o.reason.empty())
      findReason(track, end);
  }
  heldBack_.forget();
  OtherWeights(model_, controller_, standing_).tell(goals_.tracks(), end);
}

std::vector<std::string> Verdict::lying(const Kinematics& k, double time) const {
  std::vector<std::string> names;
  for (const StandingOutcome& o : standing_.outcomes(k, time))
    if (o.fell) names.push_back(o.base);
  return names;
}

std::vector<std::string> Verdict::saturatedNow() const {
  return joints_.saturatedNow(std::vector<char>(static_cast<std::size_t>(model_.nv), 1));
}

std::vector<std::string> Verdict::atLimitsNow() const {
  return joints_.atRangeEnd(std::vector<char>(static_cast<std::size_t>(model_.nv), 1));
}

bool Verdict::fell() const {
  return std::any_of(stood_.begin(), stood_.end(), [](const StandingOutcome& o) { return o.fell; });
}

/// The dofs that could bring the robot nearer: those between base and link, the joint that is
/// farthest off, or all.
std::vector<char> Verdict::dofsOf(const GoalRecord::Track& track) const {
  std::vector<char> counts(static_cast<std::size_t>(model_.nv), 0);
  const gdd::GoalError& figure = track.last;
  if (figure.frame >= 0) {
    const int body = model_.frames[figure.frame].body;
    bool any = false;
    for (int b = body; b > 0; b = model_.bodies[b].parent)
      if (model_.bodies[b].dofs == 1) counts[model_.bodies[b].v] = 1, any = true;
    // A base that floats is moved by all joints of its robot.
    for (int i = 0; i < model_.nv && !any; ++i)
      counts[i] = model_.bodies[model_.dofs[i].body].tree == model_.bodies[body].tree &&
                  model_.bodies[model_.dofs[i].body].dofs == 1;
  } else if (figure.dof >= 0) {
    counts[figure.dof] = 1;
  } else {
    for (int i = 0; i < model_.nv; ++i)
      counts[i] = model_.bodies[model_.dofs[i].body].joint != JointKind::floating;
  }
  return counts;
}

/// Of a base that is fixed, what no configuration of the chain reaches is a share of its own.
std::string Verdict::reachReason(GoalRecord::Track& track, const SeenStep& step) const {
  const auto* reach = dynamic_cast<const gdd::Reach*>(track.goal);
  if (!reach || *track.last.what) return {};
  const int body = model_.frames[reach->frame].body;
  if (body == 0) return fmt::format("{} is fixed to the world", reach->link);
  bool isChain = false;
  for (int b = body; b > 0; b = model_.bodies[b].parent) isChain |= model_.bodies[b].dofs == 1;
  if (!isChain) return {};  // the link goes where its base goes
  const ReachLimit limit = reachLimit(model_, step.record.q, reach->frame, reach->p_FP,
                                      reach->targetAt(step.record.time).p);
  const bool floats = model_.floats(model_.bodies[body].tree);
  io::GoalOutcome& o = track.outcome;
  const double left = std::max(o.finalError, limit.withinRanges);
  const auto add = [&](const char* what, double length) {
    if (!floats && length > o.met) o.causes.push_back({what, length / left});
  };
  add("reach of the chain", limit.freely);
  add(kRanges, limit.withinRanges - limit.freely);
  const char* where = floats ? " from where its base is" : "";
  if (limit.freely > o.met)
    return fmt::format("out of reach of the chain by {}{}", lengthText(limit.freely), where);
  if (limit.withinRanges > o.met)
    return fmt::format("the ranges of its joints keep it {} away{}", lengthText(limit.withinRanges),
                       where);
  return {};
}

/// What opposes the goal, beside what its chain cannot reach. Empty where that is all, or where the
/// robot is on its way.
std::string Verdict::heldText(GoalRecord::Track& track, const SeenStep& step) {
  io::GoalOutcome& o = track.outcome;
  double out = 0.0;
  for (const io::GoalOutcome::Cause& cause : o.causes) out += cause.share;
  if (out > 0.0 && (1.0 - out) * o.finalError <= o.met) {
    for (io::GoalOutcome::Cause& cause : o.causes) cause.share /= out;
    return {};
  }
  const io::HeldBack held = heldBack_.of(track, step);
  if (held.held < kHeld && joints_.speed(dofsOf(track)) > kMoving) {
    o.causes.clear();
    return {};
  }
  if (held.causes.empty()) {
    o.causes.clear();
    return {};
  }
  track.weighed = (1.0 - out) * held.weighed;
  for (const io::GoalOutcome::Cause& cause : held.causes)
    o.causes.push_back({cause.what, (1.0 - out) * cause.share});
  nameRanges(o.causes);
  std::stable_sort(o.causes.begin(), o.causes.end(),
                   [](const auto& a, const auto& b) { return a.share > b.share; });
  if (held.singular) return "no joint brings it nearer from there";
  return "held back by " + HeldBack::text(o.causes);
}

std::string Verdict::actuationReason(const GoalRecord::Track& track) const {
  const std::vector<char> counts = dofsOf(track);
  for (int i = 0; i < model_.nv; ++i)
    if (counts[i] && model_.dofs[i].actuated) return {};
  if (controller_.limits.transmission != nullptr) return {};
  return track.last.dof >= 0 ? "which is not actuated" : "no joint of it is actuated";
}

void Verdict::findReason(GoalRecord::Track& track, const SeenStep& step) {
  io::GoalOutcome& o = track.outcome;
  o.causes.clear();
  track.weighed = 0.0;
  std::vector<std::string> parts;
  bool lost = false;  // nothing that weighs is the reason
  for (const StandingOutcome& s : standing_.outcomes(step.data.kinematics, step.record.time))
    if (s.fell || s.inAir) {
      parts.push_back(
          fmt::format("the robot of {} {}", s.base, s.fell ? "fell" : "touches nothing"));
      lost = true;
    }
  if (const int dof = track.last.dof; dof >= 0)
    parts.push_back("farthest is " + nameText(model_.jointNames[model_.dofs[dof].body]));
  if (!lost) parts.push_back(reachReason(track, step));  // of one that lies it says nothing
  if (joints_.hasSeen()) {
    parts.push_back(actuationReason(track));
    if (lost || !parts.back().empty())
      o.causes.clear();
    else
      parts.push_back(heldText(track, step));
    if (joints_.speed(dofsOf(track)) > kMoving)
      parts.emplace_back(o.bestTime >= o.judgedAt ? "still on its way when the time was up"
                                                  : "still moving when the time was up");
  }
  const auto said = std::count_if(parts.begin(), parts.end(),
                                  [](const std::string& part) { return !part.empty(); });
  if (said == (track.last.dof >= 0 ? 1 : 0))
    parts.emplace_back("other goals or the control cost outweigh it");
  o.reason = joined(parts);
}

void Verdict::tellStanding(io::Summary& summary) const {
  for (const StandingOutcome& o : stood_) {
    const double degrees = kDegrees * o.tilt;
    const std::string tilt = degrees < 0.1    ? ""
                             : degrees < 9.95 ? fmt::format("tilted by {:.1f}°", degrees)
                                              : fmt::format("tilted by {:.0f}°", degrees);
    const std::string ground = o.onGround.empty() ? ""
                                                  : fmt::format("on the ground since {:.3g} s: {}",
                                                                *o.since, listed(o.onGround));
    if (o.inAir) {
      summary.verdict.emplace_back(
          "in the air", fmt::format("base {} touches nothing at the end and {} at {:.3g} m/s",
                                    o.base, o.speed > 0.0 ? "falls" : "rises", std::abs(o.speed)));
    } else if (o.fell) {
      const std::string down =
          o.cameDown > kToldHeight ? "came down by " + lengthText(o.cameDown) : "";
      summary.verdict.emplace_back(
          "fell", fmt::format("base {}: {}", o.base, joined({down, tilt, ground})));
    } else {
      const std::string height =
          std::abs(o.cameDown) < kToldHeight
              ? "as high as at the start"
              : fmt::format("{} {} than at the start", lengthText(std::abs(o.cameDown)),
                            o.cameDown > 0.0 ? "lower" : "higher");
      summary.verdict.emplace_back(
          o.falling ? "falling" : "stood",
          fmt::format("base {}: {}", o.base, joined({height, tilt, ground})));
    }
  }
}

void Verdict::tellGoals(io::Summary& summary) const {
  const auto add = [&](const char* word, std::string text) {
    summary.verdict.emplace_back(word, std::move(text));
  };
  std::vector<std::pair<const char*, std::string>> later;
  for (const io::GoalOutcome& g : summary.goals) {
    const auto amount = [&](double x) { return figureText(x, g.unit); };
    const std::string best =
        g.began && g.bestTime < g.judgedAt
            ? fmt::format(", at best {} at {:.3g} s", amount(g.bestError), g.bestTime)
            : "";
    if (!g.began)
      later.emplace_back("not reached", fmt::format("{}: {}", g.name, g.reason));
    else if (g.isMet())
      add("reached",
          g.initialError <= g.met
              ? fmt::format("{}: off by {} at {:.3g} s", g.name, amount(g.finalError), g.judgedAt)
              : fmt::format("{}: {} left of {} at {:.3g} s, there since {:.3g} s", g.name,
                            amount(g.finalError), amount(g.initialError), g.judgedAt,
                            g.metSince.value_or(g.judgedAt)));
    else if (g.yields)
      later.emplace_back("off", fmt::format("{}: by {} at {:.3g} s: {}", g.name,
                                            amount(g.finalError), g.judgedAt, g.reason));
    else
      later.emplace_back(
          g.wasMet() ? "not kept" : "not reached",
          fmt::format("{}: {} left of {} at {:.3g} s{}: {}", g.name, amount(g.finalError),
                      amount(g.initialError), g.judgedAt, best, g.reason));
  }
  for (auto& [word, text] : later) add(word, std::move(text));
}

void Verdict::tellControls(io::Summary& summary) const {
  const auto add = [&](const char* word, const std::vector<std::string>& parts) {
    if (!parts.empty()) summary.verdict.emplace_back(word, listed(parts));
  };
  std::vector<std::string> full, fast, slid, chattered;
  for (const WatchedControl& c : joints_.saturated())
    full.push_back(
        c.amount < 0.0995
            ? fmt::format("{} in {:.2g} % of the steps", nameText(c.name), 100.0 * c.amount)
            : fmt::format("{} in {:.0f} % of the steps", nameText(c.name), 100.0 * c.amount));
  for (const FastJoint& j : joints_.tooFast())
    fast.push_back(
        fmt::format("{} at {:.3g} {}, limit {:.3g}", nameText(j.name), j.speed, j.unit, j.limit));
  for (const StandingOutcome& o : stood_)
    for (const StandingOutcome::Slide& s : o.slides)
      if (!o.fell) slid.push_back(fmt::format("{} {}", nameText(s.link), lengthText(s.way)));
  for (const WatchedControl& c : joints_.chattering())
    chattered.push_back(fmt::format("{} by {:.2g}{}{} from step to step", nameText(c.name),
                                    c.amount, c.unit.empty() ? "" : " ", c.unit));
  add("saturated", full);
  add("too fast", fast);
  add("slid", slid);
  add("chattered", chattered);
  const io::GddOutcomes& g = summary.gdd;
  if (g.uncertified() > 0)
    summary.verdict.emplace_back(
        "not certified",
        fmt::format("{} of {} steps took the best control that was found, without a certificate "
                    "that it is a minimum: {} at the iteration limit, {} at a nonsmooth point of "
                    "an elliptic cone, {} undecided",
                    g.uncertified(), g.all(), g.iterationLimit, g.nonsmoothStalls, g.undecided));
}

void Verdict::tell(const std::string& ending, const std::vector<std::string>& baseWarnings,
                   io::Summary& summary) {
  for (const GoalRecord::Track& track : goals_.tracks())
    if (!track.wasNotAsked()) summary.goals.push_back(track.outcome);
  if (!ending.empty()) summary.verdict.emplace_back(summary.outcome, ending);
  tellStanding(summary);
  if (fell() && ending.empty()) summary.outcome = "fell";
  for (const std::string& warning : baseWarnings) summary.verdict.emplace_back("base", warning);
  if (baseWarnings.empty())
    for (int t = 0; t < static_cast<int>(model_.trees.size()); ++t)
      for (const StandingOutcome& o : stood_)
        if (o.fell && bolted_[t] && o.base == model_.bodyNames[model_.trees[t].rootBody])
          summary.verdict.emplace_back("base", boltAdvice(o.base, baseOrigin_));
  if (fell() && !straightKnees_.empty()) summary.verdict.emplace_back("knees", straightKnees_);
  tellGoals(summary);
  if (summary.verdict.empty())
    summary.verdict.emplace_back(summary.outcome,
                                 fmt::format("{:.4g} s", summary.simulatedSeconds()));
  tellControls(summary);
  for (std::string& sentence : oddities_.sentences())
    summary.verdict.emplace_back("implausible", std::move(sentence));
}

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#include "apps/live/hands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/live/goal_settings.hpp"
#include "softgauss/engine/model/followers.hpp"
#include "softgauss/gdd/gdd.hpp"

namespace softgauss::live {
namespace {

/// A goal that is off begins never.
bool isOff(const gdd::Goal& goal) { return goal.startTime == kInfinity; }

/// The value at a place of a goal, where it has one.
std::optional<double> valueAt(const double* place) {
  return place ? std::optional<double>(*place) : std::nullopt;
}

}  // namespace

Hands::Hands(const RunParts& run, bool passive, Keyframes::Named states, std::string fixedWorld)
    : run_(run),
      rewind_(run.state, run.model.options.timestep),
      fixedWorld_(std::move(fixedWorld)) {
  if (!passive) {
    for (int i = 1; i <= kDrags; ++i) {
      auto drag = std::make_unique<Drag>(run_.model, i);
      drags_.push_back(drag.get());
      run_.controller.goals.push_back(std::move(drag));
    }
  }
  for (const auto& goal : run_.controller.goals) starts_.push_back(goal->startTime);
  names_ = std::make_unique<Names>(run_.model, run_.controller.goals);
  keyframes_ = std::make_unique<Keyframes>(std::move(states), run_.controller);
  names_->states = keyframes_->names();
}

std::string Hands::apply(const Event& event) {
  std::string refused = act(event);
  wakeAll(run_.state.sleep);  // whomever it may concern, in the state that there is now
  return refused;
}

std::string Hands::act(const Event& event) {
  Drag* const drag = held();
  switch (event.kind) {
    case EventKind::grab:
      return grab(event);
    case EventKind::move:
      if (!drag) return "nothing is held that could be moved";
      drag->moveTo(event.vector("target"), run_.state.time);
      return "";
    case EventKind::release:
      if (drag) drag->end();
      holding_.clear();
      weighDefaults();
      return "";
    case EventKind::pin:
      if (!drag) return "nothing is held that could be pinned";
      holding_.clear();
      return "";
    case EventKind::push:
      return push(event);
    case EventKind::letGo:
      push_.reset();
      return "";
    case EventKind::pause:
      paused_ = event.flag("on");
      stepsLeft_ = 0;
      return "";
    case EventKind::advance:
      if (!paused_) return "steps are taken one by one where the run is paused";
      stepsLeft_ += static_cast<long>(event.number("count"));
      return "";
    case EventKind::reset:
      keyframes_->reset();
      goTo(rewind_.reset());
      return "";
    case EventKind::back:
      goTo(rewind_.back(run_.state, event.number("seconds")));
      return "";
    case EventKind::gravity:
    case EventKind::effect:
      return setWorld(event);
    case EventKind::factor:
      factor_ = event.number("value");
      return "";
    case EventKind::goal:
      return setGoal(event);
    case EventKind::target:
      return moveTarget(event);
    case EventKind::joint:
      return setJoint(event);
    case EventKind::state:
      keyframes_->goTo(event.text("state"), run_.model, run_.state);
      jumped_ = true;
      return "";
    case EventKind::store:
    case EventKind::recall:
      return keyframe(event);
    case EventKind::reload:
      return "a file of events is of one model, which a live run alone can read anew";
  }
  return "";
}

Drag* Hands::held() const {
  for (Drag* drag : drags_)
    if (!holding_.empty() && drag->name() == holding_) return drag;
  return nullptr;
}

std::string Hands::grab(const Event& event) {
  if (drags_.empty()) return "nothing drives this run: links can be pushed, not dragged";
  if (Drag* before = held()) before->end();
  holding_.clear();
  weighDefaults();
  const auto free =
      std::find_if(drags_.begin(), drags_.end(), [](const Drag* drag) { return !drag->held(); });
  if (free == drags_.end())
    return fmt::format("{} points are pinned, expected fewer: switch one off", kDrags);
  const std::string& link = event.text("link");
  Drag& drag = **free;
  drag.begin(run_.model, link, event.vector("point"), event.vector("target"),
             event.maybeNumber("weight"));
  weighDefaults();
  drag.reach.stiffness = event.maybeNumber("stiffness").value_or(drag.reach.stiffness);
  drag.reach.damping = event.maybeNumber("damping").value_or(drag.reach.damping);
  if (const std::optional<double> duration = event.maybeNumber("duration"))
    drag.followFrom(placeOf(drag.reach), run_.state.time, *duration);
  holding_ = drag.name();
  return "";
}

/// Where the point of a goal is now.
Vector3 Hands::placeOf(const gdd::Reach& reach) const {
  Kinematics kinematics(run_.model);
  computeKinematics(run_.model, run_.state, kinematics);
  return framePose(run_.model, kinematics, reach.frame) * reach.p_FP;
}

std::string Hands::push(const Event& event) {
  const Frame& frame = run_.model.frames[run_.model.findFrame(event.text("link"))];
  push_ = Push{frame.body, frame.X_BF * event.vector("point"),
               event.maybeVector("force").value_or(Vector3::Zero()),
               event.maybeVector("torque").value_or(Vector3::Zero())};
  return "";
}

void Hands::addWrench(const Kinematics& kinematics, std::vector<ExternalWrench>& wrenches) const {
  if (!push_) return;
  const Vector3 r_W = kinematics.X_WB[push_->body].R * push_->p_BP;
  wrenches.push_back({push_->body, {push_->torque + r_W.cross(push_->force), push_->force}});
}

std::string Hands::setGoal(const Event& event) {
  const auto index = static_cast<std::size_t>(names_->goal(event.text("goal")));
  gdd::Goal& goal = *run_.controller.goals[index];
  const GoalSettings settings = settingsOf(goal);
  const std::pair<const char*, double*> places[] = {{"weight", settings.weight},
                                                    {"stiffness", settings.stiffness},
                                                    {"damping", settings.damping},
                                                    {"rate", settings.rate}};
  for (const auto& [field, place] : places)
    if (event.find(field) && !place)
      return fmt::format("goal '{}' has no {}", event.text("goal"), field);
  const std::optional<bool> on = event.maybeFlag("on");
  auto* drag = dynamic_cast<Drag*>(&goal);
  if (drag && on && *on && !drag->held()) return "a drag begins when a link is grabbed";
  for (const auto& [field, place] : places)
    if (const std::optional<double> value = event.maybeNumber(field)) *place = *value;
  if (on) switchGoal(index, *on);
  weighDefaults();
  return "";
}

std::string Hands::moveTarget(const Event& event) {
  gdd::Goal& goal = *run_.controller.goals[idx(names_->goal(event.text("goal")))];
  double* const place = goal.soughtPlace();
  if (!place) return fmt::format("goal '{}' has no place that could be moved", event.text("goal"));
  std::copy_n(event.vector("place").data(), 3, place);
  return "";
}

void Hands::switchGoal(std::size_t index, bool on) {
  gdd::Goal& goal = *run_.controller.goals[index];
  auto* drag = dynamic_cast<Drag*>(&goal);
  if (drag && !on) {
    if (holding_ == drag->name()) holding_.clear();
    drag->end();
  } else if (!drag) {
    goal.startTime = on ? starts_[index] : kInfinity;
  }
}

/// As simulate_gdd has set them up; postures, their weights and drags come and go here.
void Hands::weighDefaults() { gdd::weighDefaults(run_.model, run_.controller.goals); }

std::string Hands::keyframe(const Event& event) {
  const double number = event.number("slot");
  const int slot = static_cast<int>(number);
  if (slot != number) return fmt::format("'slot': found {}, expected a whole number", number);
  if (event.kind == EventKind::store) {
    keyframes_->store(slot, run_.state);
    return "";
  }
  if (!keyframes_->recall(slot, run_.model, run_.state))
    return fmt::format("nothing is stored in {}, expected one of what was stored", slot);
  jumped_ = true;
  return "";
}

std::string Hands::setJoint(const Event& event) {
  const JointName& joint = names_->joint(event.text("joint"));
  if (!paused())
    return keyframes_->seek(run_.model, joint.body, event.number("position"))
               ? ""
               : "nothing could seek it; joints are put somewhere where the run is paused";
  const Body& body = run_.model.bodies[joint.body];
  State& state = run_.state;
  state.q[body.q] = event.number("position");
  state.v[body.v] = 0.0;
  placeFollowers(run_.model, {joint.body}, state.q);
  // What the last step has found is of another place.
  state.warmstart = State(run_.model).warmstart;
  state.forgetLastStep();
  jumped_ = true;
  return "";
}

std::string Hands::setWorld(const Event& event) {
  if (!fixedWorld_.empty()) return fixedWorld_;
  Options& options = run_.model.options;
  if (event.kind == EventKind::gravity)
    options.gravity = event.vector("acceleration");
  else if (const Effect effect = *effectFromName(event.text("effect")); event.flag("on"))
    options.effects.insert(effect);
  else
    options.effects.remove(effect);
  run_.data.emplace(run_.model);
  return "";
}

void Hands::goTo(const Rewind::Place& place) {
  run_.state = *place.state;
  run_.instant = place.instant;
  jumped_ = true;
}

std::vector<Hands::GoalView> Hands::goals() const {
  std::vector<GoalView> views;
  for (std::size_t i = 0; i < run_.controller.goals.size(); ++i) {
    gdd::Goal& goal = *run_.controller.goals[i];
    const GoalSettings s = settingsOf(goal);
    GoalView view;
    view.name = names_->goals[i];
    view.on = !isOff(goal);
    view.acts = goal.actsAt(run_.state.time);
    if (std::isfinite(starts_[i])) view.start = starts_[i];
    if (std::isfinite(goal.endTime)) view.end = goal.endTime;
    view.weight = valueAt(s.weight);
    view.stiffness = valueAt(s.stiffness);
    view.damping = valueAt(s.damping);
    view.rate = valueAt(s.rate);
    view.weightUnit = s.weightUnit;
    view.weightIsDefault = s.weightIsDefault;
    const auto* drag = dynamic_cast<const Drag*>(&goal);
    view.canBegin = drag && !drag->held();
    const auto* reach = drag ? &drag->reach : dynamic_cast<const gdd::Reach*>(&goal);
    if (reach && (drag || !reach->trajectory)) {  // of another trajectory the page knows nothing
      view.link = reach->link;
      view.point = reach->p_FP;
      view.target = reach->p_WTarget;
      if (reach->minimumJerk) view.jerkStart = reach->minimumJerk->startTime;
      view.consistent = reach->metric == gdd::LinkMetric::consistent;
      if (reach->R_WTarget) {
        view.orientation = Eigen::Quaterniond(*reach->R_WTarget);
        view.rotationWeight = reach->rotationWeight;
        view.rotationWeightIsDefault = reach->defaultRotationWeight.isAt(reach->rotationWeight);
      }
      if (drag && drag->duration)
        view.duration = drag->duration;
      else if (reach->minimumJerk)
        view.duration = reach->minimumJerk->duration;
    }
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace softgauss::live

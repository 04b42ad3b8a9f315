// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/plan_targets.hpp"

#include <algorithm>

#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss {

using io::PlanTask;

PlanPlace::PlanPlace(const Model& model, const PlanTask::Point& point, bool fixed)
    : target(point.target),
      link_(point.link),
      frame_(model.findFrame(point.link)),
      p_FP_(point.p_LP),
      fixed_(fixed) {}

bool PlanPlace::isOf(const PlanTask::Point& point) const {
  return point.link == link_ && point.p_LP == p_FP_ && point.target == target;
}

std::optional<gdd::GoalMark> PlanPlace::mark(const gdd::GoalContext& context) const {
  const Vector3 p_WP = framePose(context.model, context.data.kinematics, frame_) * p_FP_;
  return gdd::GoalMark{frame_, p_WP, target};
}

PlanPosture::PlanPosture(const Model& model, const PlanTask& task, bool fixed)
    : q(task.q.back()), fixed_(fixed) {
  for (int b = 1; b < model.bodyCount() && base_ < 0; ++b) {
    const Body& body = model.bodies[idx(b)];
    if (body.joint != JointKind::floating) continue;
    const auto weighs = [&](const PlanTask::StateWeights& weights) {
      return !weights.position.segment<3>(body.v).isZero(0.0);
    };
    if (weighs(task.running) || weighs(task.final)) base_ = b;
  }
  if (base_ >= 0) frame_ = model.findFrame(model.bodyNames[idx(base_)]);
  if (base_ >= 0) at_ = model.bodies[idx(base_)].q;
}

std::optional<gdd::GoalMark> PlanPosture::mark(const gdd::GoalContext& context) const {
  if (frame_ < 0) return std::nullopt;
  return gdd::GoalMark{frame_, context.data.kinematics.X_WB[idx(base_)].p, q.segment<3>(at_)};
}

double* PlanPosture::soughtPlace() { return fixed_ || frame_ < 0 ? nullptr : q.data() + at_; }

void PlanTargets::join(const Model& model, const PlanTask& task, bool fixed,
                       std::vector<std::unique_ptr<gdd::Goal>>& goals) {
  running_ = task.running, final_ = task.final;
  auto posture = std::make_unique<PlanPosture>(model, task, fixed);
  posture_ = posture.get();
  goals.push_back(std::move(posture));
  places_.clear();
  const auto placesOf = [&](const PlanTask::StateWeights& weights) {
    std::vector<std::size_t> of;
    for (const PlanTask::Point& point : weights.points) {
      const auto place = std::find_if(places_.begin(), places_.end(),
                                      [&](const PlanPlace* p) { return p->isOf(point); });
      of.push_back(static_cast<std::size_t>(place - places_.begin()));
      if (place != places_.end()) continue;
      auto added = std::make_unique<PlanPlace>(model, point, fixed);
      places_.push_back(added.get());
      goals.push_back(std::move(added));
    }
    return of;
  };
  placeOfRunning_ = placesOf(running_);
  placeOfFinal_ = placesOf(final_);
  seen_ = seen(0.0);
}

PlanTargets::Seen PlanTargets::seen(double time) const {
  Seen now{posture_->q, {}, {posture_->actsAt(time)}};
  for (const PlanPlace* place : places_) {
    now.places.push_back(place->target);
    now.acts.push_back(place->actsAt(time));
  }
  return now;
}

/// The weights that the file gives, of the targets as they are now.
PlanTask::StateWeights PlanTargets::at(const Seen& now, const PlanTask::StateWeights& given,
                                       const std::vector<std::size_t>& placeOf) const {
  PlanTask::StateWeights weights = given;
  if (!now.acts[0]) weights.position.setZero();
  for (std::size_t i = 0; i < weights.points.size(); ++i) {
    weights.points[i].target = now.places[placeOf[i]];
    if (!now.acts[1 + placeOf[i]]) weights.points[i].weight = 0.0;
  }
  return weights;
}

/// Asked at every step: nothing is copied.
bool PlanTargets::isAsSeen(double time) const {
  if (posture_->actsAt(time) != seen_.acts[0] || posture_->q != seen_.q) return false;
  for (std::size_t i = 0; i < places_.size(); ++i)
    if (places_[i]->actsAt(time) != seen_.acts[1 + i] || places_[i]->target != seen_.places[i])
      return false;
  return true;
}

bool PlanTargets::update(double time, PlanTask& task) {
  if (!posture_ || isAsSeen(time)) return false;
  Seen now = seen(time);
  if (now.q != seen_.q) task.q = {now.q}, task.v = {VectorX::Zero(task.v.back().size())};
  task.running = at(now, running_, placeOfRunning_);
  task.final = at(now, final_, placeOfFinal_);
  seen_ = std::move(now);
  return true;
}

}  // namespace softgauss

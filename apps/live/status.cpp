// SPDX-License-Identifier: Apache-2.0
#include "apps/live/status.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "softgauss/io/nearest_rank.hpp"

namespace softgauss::live {
namespace {

using nlohmann::ordered_json;

ordered_json toJson(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

ordered_json toJson(const Hands::GoalView& goal) {
  ordered_json json = {{"name", goal.name}, {"on", goal.on}, {"acts", goal.acts}};
  if (goal.start) json["start"] = *goal.start;
  if (goal.end) json["end"] = *goal.end;
  if (!goal.link.empty()) json["link"] = goal.link;
  if (goal.weight) json["weight"] = *goal.weight, json["weight_unit"] = goal.weightUnit;
  if (goal.weight && goal.weightIsDefault) json["weight_default"] = true;
  if (goal.stiffness) json["stiffness"] = *goal.stiffness;
  if (goal.damping) json["damping"] = *goal.damping;
  if (goal.rate) json["rate"] = *goal.rate;
  if (goal.duration) json["duration"] = *goal.duration;
  if (goal.point) json["point"] = toJson(*goal.point);
  if (goal.target) json["target"] = toJson(*goal.target);
  if (const auto& q = goal.orientation) json["quaternion"] = {q->w(), q->x(), q->y(), q->z()};
  if (goal.rotationWeight) json["rotation_weight"] = *goal.rotationWeight;
  if (goal.rotationWeightIsDefault) json["rotation_weight_default"] = true;
  if (goal.jerkStart) json["jerk_start"] = *goal.jerkStart;
  if (goal.consistent) json["metric"] = "consistent";
  return json;
}

}  // namespace

StepTimes::Spread StepTimes::spread() {
  if (count_ == 0) return {};
  sorted_.assign(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(count_));
  std::sort(sorted_.begin(), sorted_.end());
  return {sorted_[io::nearestRank(0.5, count_)], sorted_[io::nearestRank(0.99, count_)],
          sorted_.back()};
}

std::string statusMessage(const Status& status, const Hands& hands) {
  ordered_json goals = ordered_json::array();
  for (const Hands::GoalView& goal : hands.goals())
    if (!goal.canBegin) goals.push_back(toJson(goal));
  ordered_json errors = ordered_json::array();
  for (const GoalError& e : status.errors)
    errors.push_back({{"name", e.name}, {"unit", e.unit}, {"value", e.value}});
  const io::StepRecord& r = status.record;
  const ordered_json json = {
      {"status",
       {{"time", status.time},
        {"steps", status.steps},
        {"paused", status.paused},
        {"factor", status.factor},
        {"real_time_factor", status.realTimeFactor},
        {"step_us",
         {{"p50", status.stepUs.median}, {"p99", status.stepUs.p99}, {"max", status.stepUs.most}}},
        {"rows", r.constraints},
        {"contacts", r.contacts},
        {"iterations", r.iterations},
        {"stationarity", r.stationarity},
        {"certified", status.certified},
        {"realised", r.realised},
        {"physics_violation", r.physicsViolation},
        {"penetration", r.maxPenetration},
        {"energy", r.energy},
        {"gravity", toJson(status.gravity)},
        {"effects_off", status.effectsOff},
        {"told", status.told},
        {"fallen", status.fallen},
        {"saturated", status.saturated},
        {"at_limits", status.atLimits},
        {"errors", errors},
        {"joints", status.joints},
        {"pages", status.pages},
        {"holding", hands.holding()},
        {"goals", goals}}}};
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string liveHeader(const Names& names, const std::string& token, bool passive, double weight) {
  ordered_json joints = ordered_json::array();
  for (const JointName& joint : names.joints) {
    ordered_json json = {{"name", joint.name}, {"unit", joint.turns ? "rad" : "m"}};
    if (std::isfinite(joint.lower)) json["lower"] = joint.lower;
    if (std::isfinite(joint.upper)) json["upper"] = joint.upper;
    joints.push_back(json);
  }
  const ordered_json json = {{"path", token.empty() ? "/run" : "/run?token=" + token},
                             {"passive", passive},
                             {"weight", weight},
                             {"joints", joints},
                             {"effects", names.effects}};
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace softgauss::live

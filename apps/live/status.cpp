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
  ordered_json out = {{"name", goal.name}, {"on", goal.on}, {"acts", goal.acts}};
  if (goal.start) out["start"] = *goal.start;
  if (goal.end) out["end"] = *goal.end;
  if (!goal.link.empty()) out["link"] = goal.link;
  if (goal.weight) out["weight"] = *goal.weight, out["weight_unit"] = goal.weightUnit;
  if (goal.weight && goal.weightIsDefault) out["weight_default"] = true;
  if (goal.stiffness) out["stiffness"] = *goal.stiffness;
  if (goal.damping) out["damping"] = *goal.damping;
  if (goal.rate) out["rate"] = *goal.rate;
  if (goal.duration) out["duration"] = *goal.duration;
  if (goal.point) out["point"] = toJson(*goal.point);
  if (goal.target) out["target"] = toJson(*goal.target);
  if (const auto& q = goal.orientation) out["quaternion"] = {q->w(), q->x(), q->y(), q->z()};
  if (goal.rotationWeight) out["rotation_weight"] = *goal.rotationWeight;
  if (goal.rotationWeightIsDefault) out["rotation_weight_default"] = true;
  if (goal.jerkStart) out["jerk_start"] = *goal.jerkStart;
  if (goal.consistent) out["metric"] = "consistent";
  return out;
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
  const ordered_json out = {
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
        {"targets", status.targets},
        {"stored", hands.keyframes().stored()},
        {"pages", status.pages},
        {"loads", status.loads},
        {"holding", hands.holding()},
        {"goals", goals}}}};
  return out.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string liveHeader(const Names& names, const LivePage& page) {
  ordered_json joints = ordered_json::array();
  for (const JointName& joint : names.joints) {
    ordered_json out = {{"name", joint.name}, {"unit", joint.turns ? "rad" : "m"}};
    if (std::isfinite(joint.lower)) out["lower"] = joint.lower;
    if (std::isfinite(joint.upper)) out["upper"] = joint.upper;
    joints.push_back(out);
  }
  const ordered_json out = {{"path", page.token.empty() ? "/run" : "/run?token=" + page.token},
                            {"loads", page.loads},
                            {"passive", page.passive},
                            {"weight", page.weight},
                            {"joints", joints},
                            {"effects", names.effects},
                            {"states", names.states}};
  return out.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace softgauss::live

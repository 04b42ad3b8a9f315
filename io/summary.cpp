// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/summary.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/output_file.hpp"
#include "softgauss/io/nearest_rank.hpp"

namespace softgauss::io {
namespace {

using nlohmann::ordered_json;

ordered_json timeOf(const Series& series) {
  return {
      {"mean", series.mean()}, {"p50", series.percentile(0.5)}, {"p95", series.percentile(0.95)}};
}

ordered_json spreadOf(const Series& series) {
  return {{"p50", series.percentile(0.5)}, {"p95", series.percentile(0.95)}, {"max", series.max()}};
}

ordered_json countsOf(const Series& series) {
  return {{"p50", std::llround(series.percentile(0.5))},
          {"p95", std::llround(series.percentile(0.95))},
          {"max", std::llround(series.max())}};
}

/// Places have the unit in their keys; other goals beside them.
ordered_json toJson(const GoalOutcome& goal) {
  ordered_json json = {{"name", goal.name}, {"unit", goal.unit}};
  const std::string suffix = goal.unit == "m" ? "_m" : "";
  json["initial_error" + suffix] = goal.initialError;
  json["final_error" + suffix] = goal.finalError;
  json["best_error" + suffix] = goal.bestError;
  json["best_time_s"] = goal.bestTime;
  json["judged_at_s"] = goal.judgedAt;
  json["reached_within"] = goal.met;
  json["reached"] = goal.isMet();
  json["reason"] = goal.reason;
  json["held_back_by"] = ordered_json::array();
  for (const GoalOutcome::Cause& cause : goal.causes)
    json["held_back_by"].push_back({{"what", cause.what}, {"share", cause.share}});
  if (goal.otherWeight)
    json["with_weight"] = {{"weight", goal.otherWeight->weight},
                           {"error" + suffix, goal.otherWeight->error}};
  return json;
}

ordered_json toJson(const RunOrigin& origin) {
  ordered_json files = ordered_json::array();
  for (const RunOrigin::File& file : origin.files)
    files.push_back({{"path", file.path}, {"sha256", file.sha256}});
  return {{"command_line", origin.commandLine},
          {"commit", origin.commit},
          {"compiler", origin.compiler},
          {"processor", origin.processor},
          {"files", files}};
}

ordered_json toJson(const PlanOutcome& plan) {
  ordered_json json = {{"status", plan.status},           {"outcome", plan.outcome},
                       {"planned_cost", plan.planned},    {"planned_final_cost", plan.finalPlanned},
                       {"iterations", plan.iterations},   {"planning_s", plan.seconds},
                       {"root_force", plan.rootForce},    {"gap", plan.gap},
                       {"certificate", plan.certificate}, {"cost", plan.cost},
                       {"running_cost", plan.running},    {"effort_cost", plan.effort},
                       {"final_cost", plan.final}};
  if (plan.ticks > 0)
    json["ticks"] = {{"count", plan.ticks},
                     {"failed", plan.failedTicks},
                     {"p50_ms", plan.tickMs.percentile(0.5)},
                     {"p999_ms", plan.tickMs.percentile(0.999)}};
  return json;
}

}  // namespace

double Series::percentile(double share) const {
  if (values.empty()) return 0.0;
  std::vector<double> sorted = values;
  const auto place =
      sorted.begin() + static_cast<std::ptrdiff_t>(nearestRank(share, sorted.size()));
  std::nth_element(sorted.begin(), place, sorted.end());
  return *place;
}

void Series::add(double value) {
  const auto drop = [&](double x) {
    ++dropped;
    droppedSum += x;
    droppedMax = std::max(droppedMax, x);
  };
  if (skip > 0) {
    --skip;
    return drop(value);
  }
  values.push_back(value);
  skip = every - 1;
  if (values.size() < kMost) return;
  for (std::size_t i = 1; i < values.size(); i += 2) {
    drop(values[i]);
    values[i / 2] = values[i - 1];
  }
  values.resize(values.size() / 2);
  every *= 2;
  skip = every - 1;
}

double Series::max() const {
  return values.empty() ? 0.0
                        : std::max(droppedMax, *std::max_element(values.begin(), values.end()));
}

double Series::mean() const {
  if (values.empty()) return 0.0;
  return (std::accumulate(values.begin(), values.end(), 0.0) + droppedSum) /
         (static_cast<double>(values.size()) + static_cast<double>(dropped));
}

Summary::Summary(const Model& model)
    : integrator(integratorName(model.options.integrator)),
      massKg(model.totalMass()),
      warnings(model.warnings),
      modelName_(model.name),
      links_(static_cast<int>(model.frames.size())),
      dofs_(model.nv),
      timestep_(model.options.timestep),
      cone_(model.options.cone == Cone::elliptic ? "elliptic" : "pyramidal"),
      impedanceRatio_(model.options.impedanceRatio),
      exactDiagonal_(model.options.exactDiagonal),
      stepDoubling_(model.options.stepDoubling),
      tolerance_(model.options.tolerance) {
  for (std::size_t m = 0; m < std::size(kMechanismNames); ++m) {
    const MechanismName& name = kMechanismNames[m];
    if (!model.options.mechanisms.has(name.mechanism)) without_.emplace_back(name.name);
    if (model.options.uses(name.mechanism)) mechanismsInUse_.push_back(m);
  }
  for (int i = 0; i < model.nv; ++i) {
    const Dof& dof = model.dofs[static_cast<std::size_t>(i)];
    if (!dof.actuated) continue;
    ++actuated_;
    const double effort = std::max(-dof.effortLower, dof.effortUpper);
    if (!std::isfinite(effort) || effort <= 0.0) continue;
    bounded_.push_back({i, effort});
    ratios_.push_back({model.jointNames[static_cast<std::size_t>(dof.body)]});
  }
}

void Summary::addStep(const StepRecord& r) {
  if (steps_ == 0) {
    startTime_ = r.time;
    initialEnergy_ = r.energy;
  }
  finish(r);
  ++steps_;
  forwardUs_.add(r.forwardUs);
  gddUs_.add(r.gddUs);
  stepUs_.add(r.stepUs);
  constraints_.add(r.constraints);
  iterations_.add(r.iterations);
  dualUpdates_.add(r.dualUpdates);
  physicsViolation_.add(r.physicsViolation);
  realised_.add(r.realised);
  gddViolation_.add(r.gddViolation);
  stationarity_.add(r.stationarity);
  for (std::size_t i = 0; i < bounded_.size(); ++i)
    ratios_[i].ratio =
        std::max(ratios_[i].ratio, std::abs(r.u[bounded_[i].dof]) / bounded_[i].effort);
}

void Summary::addControlRatio(const std::string& name, double ratio) {
  for (std::size_t i = bounded_.size(); i < ratios_.size(); ++i) {
    if (ratios_[i].name != name) continue;
    ratios_[i].ratio = std::max(ratios_[i].ratio, ratio);
    return;
  }
  ratios_.push_back({name, ratio});
}

std::vector<ControlRatio> Summary::controlRatios() const {
  std::vector<ControlRatio> ratios = ratios_;
  std::stable_sort(ratios.begin(), ratios.end(),
                   [](const ControlRatio& a, const ControlRatio& b) { return a.ratio > b.ratio; });
  return ratios;
}

void Summary::finish(const StepRecord& finalState) {
  endTime_ = finalState.time;
  finalEnergy_ = finalState.energy;
  maxPenetration_ = std::max(maxPenetration_, finalState.maxPenetration);
}

double Summary::realTimeFactor() const {
  return wallSeconds > 0.0 ? simulatedSeconds() / wallSeconds : 0.0;
}

std::string Summary::json() const {
  ordered_json goalList = ordered_json::array(), said = ordered_json::array();
  for (const GoalOutcome& goal : goals) goalList.push_back(toJson(goal));
  for (const auto& [word, sentence] : verdict) said.push_back(word + ": " + sentence);
  const std::vector<ControlRatio> ratios = controlRatios();
  ordered_json ratioList = ordered_json::object();
  for (const ControlRatio& r : ratios) ratioList[r.name] = r.ratio;
  ordered_json summary = {
      {"format", 1},
      {"version", version},
      {"origin", toJson(origin)},
      {"model",
       {{"name", modelName_},
        {"links", links_},
        {"dof", dofs_},
        {"actuated", actuated_},
        {"mass_kg", massKg}}},
      {"options",
       {{"timestep_s", timestep_},
        {"integrator", integrator},
        {"step_doubling", stepDoubling_},
        {"tolerance", tolerance_},
        {"cone", cone_},
        {"impedance_ratio", impedanceRatio_},
        {"exact_diagonal", exactDiagonal_},
        {"without", without_},
        {"gdd_solver", gddSolver},
        {"control_cost", controlCost}}},
      {"outcome", outcome},
      {"verdict", said},
      {"bases", bases},
      {"steps", steps_},
      {"state_hash", stateHash},
      {"simulated_s", simulatedSeconds()},
      {"wall_s", wallSeconds},
      {"real_time_factor", realTimeFactor()},
      {"effects", effects},
      {"time_us",
       {{"forward", timeOf(forwardUs_)}, {"gdd", timeOf(gddUs_)}, {"step", timeOf(stepUs_)}}},
      {"constraints", countsOf(constraints_)},
      {"iterations", countsOf(iterations_)},
      {"dual_updates", countsOf(dualUpdates_)},
      {"physics_violation", spreadOf(physicsViolation_)},
      {"gdd_violation", spreadOf(gddViolation_)},
      {"stationarity", spreadOf(stationarity_)},
      {"realised", spreadOf(realised_)},
      {"gdd_minima",
       {{"certified", gdd.certified},
        {"kinks", gdd.nonsmoothMinima},
        {"iteration_limit", gdd.iterationLimit},
        {"bend", gdd.nonsmoothStalls},
        {"undecided", gdd.undecided},
        {"restarts", gdd.restarts}}},
      {"fallbacks",
       {{"short_solves", fallbacks.unconvergedSolves},
        {"rounded_solves", fallbacks.roundingLimitedSolves},
        {"refused_guesses", fallbacks.invalidWarmStarts},
        {"abandoned_trees", fallbacks.abandonedTrees},
        {"held_swings", fallbacks.stabilisedBodies},
        {"jumps", fallbacks.minimumStepsAccepted},
        {"unseen", fallbacks.possibleTunnelling}}},
      {"goals", goalList},
      {"energy_J", {{"initial", initialEnergy_}, {"final", finalEnergy_}}},
      {"max_penetration_m", maxPenetration_},
      {"max_control_ratio", ratios.empty() ? 0.0 : ratios.front().ratio},
      {"control_ratios", ratioList},
      {"warnings", warnings}};
  for (const std::size_t m : mechanismsInUse_)
    summary["mechanisms"][std::string(kMechanismNames[m].name)] = mechanismActs[m];
  if (integration.evaluations > 0)
    summary["integration"] = {{"evaluations", integration.evaluations},
                              {"substeps", integration.substeps},
                              {"rejections", integration.rejections},
                              {"glances", integration.tunnellingSplits}};
  else if (integration.parts > static_cast<long>(steps_) || integration.repeats > 1)
    summary["integration"] = {{"parts", integration.parts}, {"repeats", integration.repeats}};
  if (sleep.on)
    summary["sleep"] = {{"trees", sleep.trees},
                        {"most_asleep", sleep.most},
                        {"asleep_share", sleep.asleepShare()},
                        {"wakeups", sleep.wakeups}};
  if (error.estimated)
    summary["error"] = {{"position_m", error.position},
                        {"orientation_rad", error.orientation},
                        {"of", error.ofSteps ? "steps, added up" : "the run"}};
  if (plan) summary["plan"] = toJson(*plan);
  // Names come from files: bytes that are no UTF-8 are replaced, not refused.
  return summary.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

void Summary::write(const std::filesystem::path& file) const {
  detail::OutputFile out(file, "summary");
  out.write(json());
  out.commit();
}

}  // namespace softgauss::io

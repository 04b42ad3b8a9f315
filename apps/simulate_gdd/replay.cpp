// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/replay.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>

namespace softgauss::app {
namespace {

/// ", 2.7 MB" of a file, nothing of a folder.
std::string sizeOf(const std::filesystem::path& target) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(target, error);
  return error ? std::string() : fmt::format(", {:.2g} MB", 1e-6 * static_cast<double>(bytes));
}

constexpr double kUnknownDuration = 60.0;  // [s] for which memory is fetched of a run without end

}  // namespace

std::string runBeside(const SimulateOptions& options) {
  return options.viewWith.empty() ? std::string() : io::runInPage(options.viewWith);
}

std::string planBeside(const PlanControl& plan, const Scene& scene) {
  const planning::MotionPlan& planned = plan.planner().plan();
  const Model& model = scene.model;
  Data data(model);
  State state = scene.initial;
  io::StepRecord record;
  record.a = record.u = VectorX::Zero(model.nv);
  computeKinematics(model, state, data.kinematics);
  io::Recording recording(model, {}, {model, state, data});
  recording.command = "the plan";
  for (std::size_t t = 0; t < planned.q.size(); ++t) {
    const bool last = t + 1 == planned.q.size();
    state.q = record.q = planned.q[t];
    state.v = record.v = planned.v[t];
    record.time = static_cast<double>(t) * plan.task().steps.step;
    record.isEnd = last;
    if (!last) record.a = planned.a[t], record.u = planned.tau[t];
    computeKinematics(model, state, data.kinematics);
    last ? recording.finish(record, data) : recording.addStep(record, data, {});
  }
  return io::runText(recording, "softgauss");
}

Replay::Replay(const SimulateOptions& options, const Scene& scene,
               const std::vector<std::unique_ptr<gdd::Goal>>& goals, const gdd::GoalContext& start)
    : view_(options.view), drawing_(options.plot) {
  if (!options.view.empty())
    page_.emplace(options.view, options.planControl && options.viewWith.empty()
                                    ? planBeside(*options.planControl, scene)
                                    : runBeside(options));
  if (!options.plot.empty()) plot_.emplace(options.plot);
  if (!page_ && !plot_) return;
  recording_.emplace(scene.model, goals, start);
  recording_->command = options.commandLine;
  plan_ = options.planControl;
  if (plan_)
    recording_->addPlot("Cost of the plan", "1/s",
                        {"states", "control", "states, planned", "control, planned"});
  const double duration = std::isfinite(options.duration) ? options.duration : kUnknownDuration;
  recording_->reserve(static_cast<std::size_t>(duration / scene.model.options.timestep), duration);
  if (!page_) return;
  recording_->hulls = collidingHulls(scene);
  recording_->images = visualImages(scene.model, options.largestMesh, warnings_);
}

void Replay::showCost(const io::StepRecord& record) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const MotionCost now = plan_->rate(record.q, record.v, record.u);
  const MotionCost planned = plan_->plannedRate(record.time).value_or(MotionCost{kNone, kNone});
  recording_->added = {now.running, now.effort, planned.running, planned.effort};
}

std::vector<std::string> Replay::finish(const io::StepRecord& last, const Data& data,
                                        const io::Summary& summary, const std::string& message) {
  if (!recording_) return {};
  recording_->finish(last, data);
  recording_->outcome = {summary.outcome, message};
  recording_->facts = summary.facts();
  recording_->warnings = summary.warnings;
  std::vector<std::string> failures;
  // Each is tried, whatever became of the other.
  const auto attempt = [&](const std::filesystem::path& target, auto&& write) {
    const auto start = std::chrono::steady_clock::now();
    try {
      write();
    } catch (const std::exception& error) {
      failures.emplace_back(error.what());
      return;
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    written_ +=
        fmt::format("wrote {}{} in {:.2g} s\n", target.string(), sizeOf(target), time.count());
  };
  const std::string generator = fmt::format("softgauss {}", summary.version);
  if (page_) attempt(view_, [&] { page_->write(*recording_, generator); });
  if (plot_) attempt(drawing_, [&] { plot_->write(*recording_); });
  return failures;
}

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/runner.hpp"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "apps/shared/cpu_time.hpp"
#include "apps/shared/file_hash.hpp"
#include "apps/simulate_gdd/scene.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/simulation/time_grid.hpp"

namespace softgauss::app {
namespace {

/// What the rollout's own start is to leave out: setUp() gives all goals.
SimulationOptions rolloutOptions(const SimulateOptions& options) {
  SimulationOptions o = loadOptions(options);
  o.withoutGoals = true;
  return o;
}

std::string csvText(std::string text) {
  for (char& c : text)
    if (c == '"' || c == '\n' || c == '\t') c = c == '"' ? '\'' : ' ';
  return text.empty() ? text : '"' + text + '"';
}

}  // namespace

std::optional<io::PlanTask> sweptTask(const Sweep& sweep, const Scene& scene) {
  if (!sweep.planned()) return std::nullopt;
  io::PlanTask task = io::readPlanTask(sweep.options.model, scene.model, scene.initial);
  if (sweep.options.mpc && std::isfinite(task.mpc.seconds))
    throw ModelError({sweep.file.string(), 0}, "key 'mpc'",
                     "ticks of the scene end by the clock (plan.mpc.seconds), so that a run would "
                     "differ from time to time; expected none of it");
  return task;
}

SweepRunner::SweepRunner(const Sweep& sweep, int threads)
    : sweep_(sweep),
      scene_(loadScene(sweep.options)),
      duration_(sweep.options.duration),
      runs_(planRuns(sweep, scene_->model)),
      rollout_(std::make_unique<Rollout>(*scene_, rolloutOptions(sweep.options), threads)) {
  Simulation sim(copyOf(*scene_), rolloutOptions(sweep.options));
  setUp(sweep.options, sim.scene(), sim.controller());
  for (std::size_t p = 0; p < runs_.parameters.size(); ++p) {
    try {
      Parameter(scene_->model, runs_.parameters[p]).apply(0.0, sim.controller());
    } catch (const NameError& error) {
      throw ModelError(sweep.varied[p].where, "key 'vary'", error.what());
    }
  }
  task_ = sweptTask(sweep, *scene_);
  if (task_) {
    const std::unique_ptr<PlanControl> plan = planOf(*scene_);
    plan->attach(sim.controller());
    if (!sweep.options.hasDuration) duration_ = plan->duration();
  }
  columns_ = RunFigures(sweep, sim).columns();
}

std::unique_ptr<PlanControl> SweepRunner::planOf(const Scene& scene) const {
  if (!task_) return nullptr;
  return std::make_unique<PlanControl>(scene, *task_, sweep_.options.mpc);
}

std::string SweepRunner::header() const {
  std::string text = "run,seed";
  for (const std::string& name : runs_.parameters) text += "," + csvField(name);
  text += ",outcome,simulated_s";
  for (const std::string& name : columns_) text += "," + csvField(name);
  return text + ",failure";
}

std::string SweepRunner::origin() const {
  std::string text = SOFTGAUSS_VERSION;
  std::vector<std::filesystem::path> files = {sweep_.file, sweep_.options.model,
                                              sweep_.options.goals};
  files.insert(files.end(), scene_->contents.files.begin(), scene_->contents.files.end());
  for (const std::filesystem::path& file : files)
    if (!file.empty()) text += " " + sha256(file).substr(0, 16);
  return text;
}

std::string SweepRunner::rowOf(long run, const std::string& outcome, double time,
                               const std::vector<double>& figures,
                               const std::string& failure) const {
  const auto at = static_cast<std::size_t>(run);
  std::string row = fmt::format("{},{}", run, runs_.seeds[at]);
  const auto add = [&](double x) {
    row += ',';
    if (std::isfinite(x)) io::detail::appendNumber(row, x);
  };
  const std::size_t columns = runs_.parameters.size();
  for (std::size_t p = 0; p < columns; ++p) add(runs_.values[at * columns + p]);
  row += "," + outcome;
  add(time);
  for (std::size_t i = 0; i < columns_.size(); ++i) add(i < figures.size() ? figures[i] : kNaN);
  return row + "," + csvText(failure);
}

void SweepRunner::run(const std::vector<long>& list, const std::function<void(RunRow)>& done,
                      const std::atomic<bool>& stop) {
  struct Own {
    std::unique_ptr<PlanControl> plan;
    std::unique_ptr<RunFigures> figures;
    double begin = 0.0, seconds = 0.0, time = 0.0;
    std::vector<double> values;
  };
  std::vector<Own> own(list.size());
  const std::size_t columns = runs_.parameters.size();
  std::vector<double> values;
  std::vector<std::uint64_t> seeds;
  for (const long run : list) {
    const auto from = runs_.values.begin() + static_cast<std::ptrdiff_t>(columns) * run;
    values.insert(values.end(), from, from + static_cast<std::ptrdiff_t>(columns));
    seeds.push_back(runs_.seeds[static_cast<std::size_t>(run)]);
  }
  const auto ownOf = [&](const RolloutRun& run) -> Own& {
    return own[static_cast<std::size_t>(run.index)];
  };
  std::vector<RunOutcome> outcomes;
  RolloutInputs in{.runs = static_cast<long>(list.size()), .steps = 1L << 40};
  in.parameters = runs_.parameters;
  in.values = values;
  in.seeds = seeds;
  RolloutHooks hooks;
  hooks.stop = &stop;
  hooks.begin = [&](RolloutRun& run) {
    ownOf(run).begin = cpuSeconds();
    setUp(sweep_.options, run.sim.scene(), run.sim.controller());
    const std::unique_ptr<PlanControl>& plan = ownOf(run).plan = planOf(run.sim.scene());
    if (!plan) return;
    plan->solve();
    plan->attach(run.sim.controller());
    plan->begin(run.sim.state());
  };
  hooks.before = [&](RolloutRun& run) {
    Own& o = ownOf(run);
    if (!o.figures) o.figures = std::make_unique<RunFigures>(sweep_, run.sim, o.plan.get());
    o.figures->before(run.sim);
    if (o.plan) o.plan->update(run.sim.state());
  };
  hooks.after = [&](RolloutRun& run) {
    const Own& o = ownOf(run);
    const double h = run.sim.model().options.timestep;
    o.figures->after(run.sim);
    if (o.plan) o.plan->addStep(run.sim.controller().control, h);
    // As many steps as simulate_gdd takes.
    return run.step < stepsIn(duration_, h);
  };
  hooks.end = [&](RolloutRun& run) {
    Own& o = ownOf(run);
    if (o.figures && !isRefused(run.sim.data().stats.status)) {
      o.figures->finish(run.sim);
      o.values = o.figures->values();
    }
    o.time = run.sim.time();
    o.figures.reset();
    o.plan.reset();
    o.seconds = cpuSeconds() - o.begin;
  };
  hooks.finished = [&](long index, const RunOutcome& outcome) {
    if (outcome.status == RunOutcome::Status::interrupted) return;
    const bool failed = outcome.status == RunOutcome::Status::failed;
    const Own& o = own[static_cast<std::size_t>(index)];
    const long run = list[static_cast<std::size_t>(index)];
    done({run, o.seconds,
          rowOf(run, failed ? "failed" : "completed", o.time,
                failed ? std::vector<double>{} : o.values, outcome.failure)});
  };
  rollout_->run(in, {}, hooks);
}

}  // namespace softgauss::app

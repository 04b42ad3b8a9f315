// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/batch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/shared/interrupt.hpp"
#include "apps/shared/progress.hpp"
#include "apps/shared/standard_streams.hpp"
#include "apps/shared/wall_clock.hpp"
#include "apps/simulate_batch/batch_summary.hpp"
#include "apps/simulate_batch/runner.hpp"
#include "apps/simulate_gdd/plan_run.hpp"
#include "apps/simulate_gdd/scene.hpp"
#include "softgauss/io/detail/output_file.hpp"
#include "softgauss/io/replay/gnuplot.hpp"

namespace softgauss::app {
namespace {

/// How many runs are done and how long the rest takes, on a terminal.
class BatchProgress {
 public:
  BatchProgress(long before, bool quiet)
      : before_(before), visible_(!quiet && isatty(fileno(stderr))) {}
  ~BatchProgress() { clear(); }

  void show(long done, long all) {
    const double elapsed = secondsSince(start_);
    if (!visible_ || elapsed - last_ < 0.1) return;
    last_ = elapsed;
    const std::string bar =
        progressBar(static_cast<double>(done) / static_cast<double>(std::max(all, 1L)));
    const double rate = static_cast<double>(done - before_) / elapsed;
    const std::string left =
        rate > 0.0 ? fmt::format("{:.0f} s left", static_cast<double>(all - done) / rate) : "";
    print(stderr,
          fmt::format("\r{} {} / {} runs   {:.4g} runs/s   {} \033[K", bar, done, all, rate, left));
    std::fflush(stderr);
  }
  void clear() {
    if (!visible_ || last_ < 0.0) return;
    print(stderr, "\r\033[K");
    last_ = -1.0;
  }

 private:
  long before_;
  bool visible_;
  double last_ = -1.0;
  const Clock::time_point start_ = Clock::now();
};

/// Sets a flag when the program is interrupted.
class InterruptWatch {
 public:
  explicit InterruptWatch(std::atomic<bool>& stop)
      : thread_([this, &stop] {
          while (!over_) {
            if (interrupted()) stop = true;
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
          }
        }) {}
  ~InterruptWatch() {
    over_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

/// One run as simulate_gdd does it.
ExitCode runOne(const Sweep& sweep, const BatchOptions& options) {
  SimulateOptions one = sweep.options;
  one.view = options.view;
  one.quiet = options.quiet;
  one.commandLine = sweep.repeatCommand(*options.only);
  const std::unique_ptr<Scene> scene = loadScene(one);
  const SweepRuns runs = planRuns(sweep, scene->model);
  if (*options.only >= runs.count)
    throw UsageError(
        fmt::format("--only {}: expected a run from 0 to {}", *options.only, runs.count - 1));
  std::vector<std::pair<Parameter, double>> parameters;
  for (std::size_t p = 0; p < runs.parameters.size(); ++p) {
    const auto at = static_cast<std::size_t>(*options.only) * runs.parameters.size() + p;
    parameters.emplace_back(Parameter(scene->model, runs.parameters[p]), runs.values[at]);
    if (!options.quiet)
      print(stdout, fmt::format("{} = {}\n", runs.parameters[p], runs.values[at]));
  }
  std::optional<io::PlanTask> task = sweptTask(sweep, *scene);
  for (const auto& [parameter, value] : parameters)
    parameter.apply(value, scene->model, scene->initial);
  if (const std::string problem = Parameter::problemOf(scene->model); !problem.empty())
    throw UsageError(fmt::format("--only {}: {}", *options.only, problem));
  one.changeGoals = [&](gdd::GoalDirectedController& controller) {
    for (const auto& [parameter, value] : parameters) parameter.apply(value, controller);
  };
  if (task) {
    takePlan(one, *scene, std::move(*task));
    if (!makePlan(one)) return kInterrupted;
  }
  return run(one, *scene);
}

void writeOutputs(const Sweep& sweep, const RunTable& table, const BatchOptions& options,
                  const BatchTimes& times) {
  table.write(options.out / "runs.csv");
  io::detail::OutputFile summary(options.out / "summary.json", "summary.json");
  summary.write(summaryJson(sweep, table, sweep.varied.size(), times));
  summary.commit();
  const std::string script = histogramScript(figureColumns(table, sweep.varied.size()));
  if (script.empty() || !io::hasGnuplot()) return;
  io::detail::OutputFile histograms(options.out / "histograms.svg", "histograms.svg");
  histograms.write(io::gnuplotDrawing(script));
  histograms.commit();
}

}  // namespace

ExitCode runBatch(const BatchOptions& options, Ranks& ranks) {
  const Sweep sweep = readSweep(options.sweep);
  if (options.only) return ranks.rank() == 0 ? runOne(sweep, options) : kDone;
  const int threads = options.threads > 0 ? options.threads : ranks.size() > 1 ? 1 : 0;
  SweepRunner runner(sweep, threads);
  const DoRuns doRuns = [&](const std::vector<long>& runs, const std::function<void(RunRow)>& done,
                            const std::atomic<bool>& stop) { runner.run(runs, done, stop); };
  std::atomic<bool> stop = false;
  catchInterrupts();
  const InterruptWatch watch(stop);
  if (ranks.rank() > 0) {
    ranks.follow(doRuns, stop, runner.rollout().threads());
    return stop ? kInterrupted : kDone;
  }

  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (!std::filesystem::is_directory(options.out))
    throw OutputError(fmt::format("--out {}: cannot be made: {}", options.out.string(),
                                  error ? error.message() : "there is a file of that name"));
  RunTable table(runner.header(), runner.runs().count);
  const std::filesystem::path checkpoint = options.out / "checkpoint.txt";
  if (options.checkpoint) table.keepIn(checkpoint, runner.origin());
  BatchTimes times;
  times.doneBefore = table.done();
  times.threads = runner.rollout().threads() * ranks.size();
  times.ranks = ranks.size();
  times.bytesPerRun = runner.rollout().bytesPerRun();
  times.bytesPerThread = runner.rollout().bytesPerThread();
  times.timestep = runner.scene().model.options.timestep;
  BatchProgress progress(times.doneBefore, options.quiet);
  const Clock::time_point start = Clock::now();
  ranks.lead(
      table, doRuns, [&] { progress.show(table.done(), table.runs()); }, stop,
      runner.rollout().threads());
  times.wallSeconds = secondsSince(start);
  progress.clear();
  if (stop) times.outcome = "interrupted";
  writeOutputs(sweep, table, options, times);
  std::error_code ignored;
  if (options.checkpoint && table.done() == table.runs())
    std::filesystem::remove(checkpoint, ignored);
  if (!options.quiet) {
    print(stdout, summaryText(sweep, table, times));
    print(stdout, fmt::format("written to {}\n", options.out.string()));
  }
  return stop ? kInterrupted : kDone;
}

}  // namespace softgauss::app

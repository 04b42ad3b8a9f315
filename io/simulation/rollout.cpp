// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/simulation/rollout.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "softgauss/engine/core/memory.hpp"
#include "softgauss/io/simulation/simulation_parts.hpp"

namespace softgauss {
namespace {

void expectSize(const char* name, std::size_t found, long runs, long rows, long columns) {
  if (found == 0) return;
  const auto expected = static_cast<std::size_t>(runs * rows * columns);
  if (found == expected) return;
  throw std::invalid_argument(
      fmt::format("rollout: {}: found {} numbers, expected {} = {} runs × {} × {}", name, found,
                  expected, runs, rows, columns));
}

/// One row of an array, empty where there is no array.
template <class T>
std::span<T> rowOf(std::span<T> array, long row, long columns) {
  if (array.empty()) return {};
  return array.subspan(static_cast<std::size_t>(row * columns), static_cast<std::size_t>(columns));
}

void copyTo(const VectorX& from, std::span<double> to) {
  if (!to.empty()) std::copy(from.data(), from.data() + from.size(), to.begin());
}

void setFrom(std::span<const double> from, VectorX& to) {
  if (!from.empty()) std::copy(from.begin(), from.end(), to.data());
}

std::size_t allocated() {
#if defined(__GLIBC__)
  const auto now = mallinfo2();
  return now.uordblks + now.hblkhd;
#else
  return 0;
#endif
}

}  // namespace

const char* statusName(RunOutcome::Status status) {
  switch (status) {
    case RunOutcome::Status::completed:
      return "completed";
    case RunOutcome::Status::ended:
      return "ended";
    case RunOutcome::Status::failed:
      return "failed";
    case RunOutcome::Status::interrupted:
      break;
  }
  return "interrupted";
}

/// What the threads share.
struct Rollout::Task {
  const RolloutInputs& in;
  const RolloutOutputs& out;
  const RolloutHooks& hooks;
  std::vector<Parameter> parameters;
  bool changesModels = false;
  std::vector<RunOutcome> outcomes;
  std::atomic<long> next{0};
  std::mutex mutex;  ///< of what follows
  long done = 0;
  std::exception_ptr error;

  long rows() const { return in.steps / out.every; }
  bool stopped() const { return hooks.stop && hooks.stop->load(std::memory_order_relaxed); }
};

/// A thread's own simulation.
struct Rollout::Worker {
  Worker(const Scene& scene, const SimulationOptions& options)
      : base(scene), sim(copyOf(scene), options), parts(sim.parts()) {}

  void run(Task& task, long index);
  const std::vector<std::string>& linkNames() const { return parts.links.names(); }

 private:
  void begin(Task& task, RolloutRun& run);
  void write(const Task& task, long index, long row);
  void fillRest(const Task& task, long index, long steps);

  const Scene& base;
  Simulation sim;
  SimulationParts& parts;
  std::vector<Snapshot::ContactForce> touching;
  VectorX forces, applied;
  bool modelIsChanged = false;  ///< by the last run
};

void Rollout::Worker::begin(Task& task, RolloutRun& run) {
  Scene& scene = *parts.scene;
  scene.initial = base.initial;
  setFrom(rowOf(task.in.q0, run.index, scene.model.nq), scene.initial.q);
  setFrom(rowOf(task.in.v0, run.index, scene.model.nv), scene.initial.v);
  const bool otherModel = task.changesModels || modelIsChanged ||
                          scene.model.options.integrator != base.model.options.integrator;
  if (otherModel) scene.model = base.model;
  modelIsChanged = task.changesModels;
  for (std::size_t p = 0; p < task.parameters.size(); ++p) {
    const Parameter& parameter = task.parameters[p];
    if (const std::string problem = parameter.problem(run.values[p]); !problem.empty())
      throw NameError(fmt::format("parameter '{}': {}", parameter.name(), problem));
    parameter.apply(run.values[p], scene.model, scene.initial);
  }
  if (const std::string problem = Parameter::problemOf(scene.model); !problem.empty())
    throw NameError(problem);
  for (std::size_t p = 0; p < task.parameters.size(); ++p)
    if (const std::string problem =
            task.parameters[p].startProblem(run.values[p], scene.model.ranges);
        !problem.empty())
      throw NameError(fmt::format("parameter '{}': {}", task.parameters[p].name(), problem));
  parts.restart(otherModel);
  if (task.hooks.begin) task.hooks.begin(run);
  for (std::size_t p = 0; p < task.parameters.size(); ++p)
    task.parameters[p].apply(run.values[p], *parts.controller);
}

void Rollout::Worker::write(const Task& task, long index, long row) {
  const RolloutOutputs& out = task.out;
  const Model& model = parts.scene->model;
  const long at = index * task.rows() + row;
  copyTo(parts.state.q, rowOf(out.q, at, model.nq));
  copyTo(parts.state.v, rowOf(out.v, at, model.nv));
  copyTo(parts.data->plan.drifts ? parts.data->acceleration : parts.data->forward.a,
         rowOf(out.a, at, model.nv));
  appliedForces(*parts.data, applied);
  copyTo(applied, rowOf(out.tau, at, model.nv));
  if (out.contactForces.empty()) return;
  contactForces(*parts.data, touching);
  parts.links.forces(touching, forces);
  copyTo(forces, rowOf(out.contactForces, at, 3 * parts.links.size()));
}

void Rollout::Worker::fillRest(const Task& task, long index, long steps) {
  const RolloutOutputs& out = task.out;
  const Model& model = parts.scene->model;
  const auto fill = [&](std::span<double> array, long columns) {
    if (array.empty()) return;
    for (long row = steps / out.every; row < task.rows(); ++row)
      std::ranges::fill(rowOf(array, index * task.rows() + row, columns), kNaN);
  };
  fill(out.q, model.nq);
  fill(out.v, model.nv);
  fill(out.a, model.nv);
  fill(out.tau, model.nv);
  fill(out.contactForces, 3 * parts.links.size());
}

void Rollout::Worker::run(Task& task, long index) {
  RunOutcome outcome;
  const auto at = static_cast<std::size_t>(index);
  RolloutRun run{index, 0, task.in.seeds.empty() ? at : task.in.seeds[at],
                 rowOf(task.in.values, index, static_cast<long>(task.parameters.size())), sim};
  try {
    begin(task, run);
    bool goesOn = true;
    while (goesOn && run.step < task.in.steps && !task.stopped()) {
      if (!task.in.tau.empty()) {
        parts.input.tau.resize(parts.scene->model.nv);
        setFrom(rowOf(task.in.tau, index * task.in.steps + run.step, parts.scene->model.nv),
                parts.input.tau);
      }
      if (task.hooks.before) task.hooks.before(run);
      if (isRefused(sim.step())) {
        outcome.status = RunOutcome::Status::failed;
        outcome.failure = sim.failure();
        break;
      }
      ++run.step;
      if (run.step % task.out.every == 0) write(task, index, run.step / task.out.every - 1);
      if (task.hooks.after) goesOn = task.hooks.after(run);
    }
    if (outcome.failure.empty() && run.step == task.in.steps)
      outcome.status = RunOutcome::Status::completed;
    else if (outcome.failure.empty() && !goesOn)
      outcome.status = RunOutcome::Status::ended;
    if (task.hooks.end) task.hooks.end(run);
  } catch (const std::exception& error) {
    outcome.status = RunOutcome::Status::failed;
    outcome.failure = error.what();
  }
  outcome.steps = run.step;
  fillRest(task, index, run.step);
  task.outcomes[at] = std::move(outcome);
}

Rollout::Rollout(const Scene& scene, const SimulationOptions& options, int threads)
    : scene_(scene),
      options_(options),
      threads_(threads > 0 ? threads
                           : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {
  workers_.resize(static_cast<std::size_t>(threads_));
  const std::size_t before = allocated();
  worker(0);
  bytesPerThread_ = allocated() - std::min(before, allocated());
}

Rollout::~Rollout() = default;

Rollout::Worker& Rollout::worker(int thread) {
  std::unique_ptr<Worker>& worker = workers_[static_cast<std::size_t>(thread)];
  if (!worker) worker = std::make_unique<Worker>(scene_, options_);
  return *worker;
}

void Rollout::work(Task& task, int thread) {
  try {
    Worker& mine = worker(thread);
    for (long run = task.next++; run < task.in.runs && !task.stopped(); run = task.next++) {
      mine.run(task, run);
      const std::lock_guard lock(task.mutex);
      ++task.done;
      if (task.hooks.finished)
        task.hooks.finished(run, task.outcomes[static_cast<std::size_t>(run)]);
      if (task.hooks.progress) task.hooks.progress(task.done, task.in.runs);
    }
  } catch (...) {  // no thread may end with it
    const std::lock_guard lock(task.mutex);
    if (!task.error) task.error = std::current_exception();
    task.next = task.in.runs;
  }
}

std::vector<RunOutcome> Rollout::run(const RolloutInputs& in, const RolloutOutputs& out,
                                     const RolloutHooks& hooks) {
  if (in.runs < 0 || in.steps < 0 || out.every < 1)
    throw std::invalid_argument(
        fmt::format("rollout: found {} runs of {} steps, every {}, expected none below 0, 0, 1",
                    in.runs, in.steps, out.every));
  Task task{in, out, hooks, {}, false, {}, {}, {}, 0, {}};
  const Model& model = scene_.model;
  const long rows = task.rows(), links = static_cast<long>(contactLinks().size());
  expectSize("q0", in.q0.size(), in.runs, 1, model.nq);
  expectSize("v0", in.v0.size(), in.runs, 1, model.nv);
  expectSize("tau", in.tau.size(), in.runs, in.steps, model.nv);
  expectSize("seeds", in.seeds.size(), in.runs, 1, 1);
  expectSize("q", out.q.size(), in.runs, rows, model.nq);
  expectSize("v", out.v.size(), in.runs, rows, model.nv);
  expectSize("a", out.a.size(), in.runs, rows, model.nv);
  expectSize("applied tau", out.tau.size(), in.runs, rows, model.nv);
  expectSize("contact forces", out.contactForces.size(), in.runs, rows, 3 * links);
  const auto columns = static_cast<long>(in.parameters.size());
  if (in.values.size() != static_cast<std::size_t>(in.runs * columns))
    throw std::invalid_argument(
        fmt::format("rollout: values: found {} numbers, expected {} = {} runs × {} parameters",
                    in.values.size(), in.runs * columns, in.runs, columns));
  for (const std::string& name : in.parameters) task.parameters.emplace_back(model, name);
  for (const Parameter& p : task.parameters) task.changesModels |= p.isOfModel();
  task.outcomes.resize(static_cast<std::size_t>(in.runs));

  const int threads = static_cast<int>(std::min<long>(threads_, std::max(1L, in.runs)));
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back([this, &task, t] { work(task, t); });
  work(task, 0);
  for (std::thread& thread : others) thread.join();
  if (task.error) std::rethrow_exception(task.error);
  return std::move(task.outcomes);
}

int Rollout::threads() const { return threads_; }
const Model& Rollout::model() const { return scene_.model; }
const std::vector<std::string>& Rollout::contactLinks() const {
  return workers_.front()->linkNames();
}

std::size_t Rollout::bytesPerRun() const {
  const State& s = scene_.initial;
  const WarmStart& w = s.warmstart;
  // A warm start has five vectors of nv once a step has been taken.
  return sizeof(State) + bytesOfAll(s.q, s.v, s.a) + bytesOf(w.breakpoints) +
         6 * static_cast<std::size_t>(scene_.model.nv) * sizeof(double);
}

std::size_t Rollout::bytesPerThread() const { return bytesPerThread_; }

std::vector<RunOutcome> rollout(const Scene& scene, const RolloutInputs& inputs,
                                const RolloutOutputs& outputs, const RolloutHooks& hooks,
                                int threads) {
  return Rollout(scene, {}, threads).run(inputs, outputs, hooks);
}

}  // namespace softgauss

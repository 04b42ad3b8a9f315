// SPDX-License-Identifier: Apache-2.0
#include "apps/gdd_benchmark/replay.hpp"

#include <fmt/format.h>

#include <chrono>
#include <stdexcept>

#include "apps/gdd_benchmark/statistics.hpp"

namespace softgauss::app {
namespace {

using Clock = std::chrono::steady_clock;

/// Microseconds since `last`, which becomes now.
double lap(Clock::time_point& last) {
  const Clock::time_point now = Clock::now();
  const double us = std::chrono::duration<double, std::micro>(now - last).count();
  last = now;
  return us;
}

/// Of one record in one pass.
struct Times {
  double stages = 0.0, forward = 0.0;
  std::vector<double> solve, finish;  ///< one a solver
};

/// What is kept of a solver that has just been run: which must not depend on the pass.
bool sameResult(const Solved& a, const Solved& b) {
  return a.report.status == b.report.status && a.report.iterations == b.report.iterations &&
         a.report.violation == b.report.violation && a.objective == b.objective &&
         a.forwardIterations == b.forwardIterations;
}

class Replayer {
 public:
  Replayer(const Robot& robot, const Dataset& dataset, const std::vector<std::string>& solvers)
      : robot_(robot),
        model_(robot.model),
        dataset_(dataset),
        data_(model_),
        cost_(model_.nv),
        limits_(model_) {
    for (const std::string& name : solvers) {
      solvers_.push_back(makeSolver(name, model_));
      result_.solvers.push_back({name, {}});
    }
    warm_.resize(solvers.size());
  }

  Replay run(int passes, Progress& progress) {
    const auto count = static_cast<long>(dataset_.records.size());
    for (int pass = 0; pass < passes && !interrupted(); ++pass) {
      for (WarmStart& warm : warm_) warm.gddValid = false;
      times_.emplace_back();
      for (long i = 0; i < count && !interrupted(); ++i) {
        progress.show(pass * count + i, passes * count);
        replayRecord(i, pass);
      }
      // Of the first pass, the records so far are whole; a part of a later one counts for nothing.
      if (interrupted() && pass > 0 && times_.back().size() < times_.front().size())
        times_.pop_back();
    }
    return finish();
  }

 private:
  void replayRecord(long i, int pass) {
    const bool first = pass == 0;
    const Record& record = dataset_.records[i];
    Times times;
    times.solve.resize(solvers_.size());
    times.finish.resize(solvers_.size());
    model_.options.timestep = record.timestep;
    model_.options.outerTimestep = record.outerTimestep;
    model_.options.nextTimestep = record.nextTimestep;
    Clock::time_point clock = Clock::now();
    computeStages(model_, robot_.input, record.state, data_, robot_.contacts.get());
    times.stages = lap(clock);
    if (first) result_.rows.push_back(data_.stats.rows);
    const long runners = static_cast<long>(solvers_.size()) + 1;
    for (long k = 0; k < runners; ++k) {
      const long who = (k + i + pass) % runners;
      if (who == 0)
        runForward(record, times, first);
      else
        runSolver(who - 1, i, times, first);
    }
    times_.back().push_back(std::move(times));
  }

  void runForward(const Record& record, Times& times, bool first) {
    setAppliedForce(record.control, data_.forces);
    Clock::time_point clock = Clock::now();
    checkFinite(forwardDynamics(model_, record.state, data_), record);
    times.forward = lap(clock);
    if (first) result_.forwardIterations.push_back(data_.forward.report.iterations);
  }

  void runSolver(long who, long i, Times& times, bool first) {
    const Record& record = dataset_.records[i];
    SolverUnderTest& solver = *solvers_[who];
    Solved solved;
    Clock::time_point clock = Clock::now();
    poseProblem(dataset_.goals[record.goal], {model_, record.state, data_}, cost_);
    solved.report = solver.solve(model_, cost_, limits_, data_, warm_[who]);
    times.solve[who] = lap(clock);
    if (solved.report.status == gdd::GddStatus::notFinite)
      checkFinite(SolveStatus::notFinite, record);
    clock = Clock::now();
    control_ = solver.force().cwiseMax(limits_.lower).cwiseMin(limits_.upper);
    setAppliedForce(control_, data_.forces);
    checkFinite(forwardDynamics(model_, &solver.acceleration(), data_), record);
    times.finish[who] = lap(clock);

    solver.keepWarmStart(warm_[who]);
    solved.forwardIterations = data_.forward.report.iterations;
    solved.controlAsRecorded = control_ == record.control;
    solved.objective = objective(record.state);
    std::vector<Solved>& results = result_.solvers[who].records;
    if (first)
      results.push_back(solved);
    else if (!sameResult(results[i], solved))
      throw std::runtime_error(fmt::format("{}: {}: record {} gave another result when repeated",
                                           robot_.name, solver.name(), i));
  }

  /// Of what acts: the last control and the last forward dynamics.
  double objective(const State& state) {
    factor_.compute(data_.inertia.M);
    scratch_ = control_;
    factor_.solve(scratch_);
    const double effort = 0.5 * control_.dot(scratch_);
    data_.inertia.M.multiply(data_.forward.a, scratch_);
    const double goals = cost_.value(data_.forward.a, scratch_);
    data_.inertia.M.multiply(state.v, scratch_);
    const gdd::VirtualDamping damping =
        datasetDamping();  // its constant, which the cost leaves out
    const double constant =
        0.5 * damping.weight * damping.rate * damping.rate * state.v.dot(scratch_);
    return effort + goals + constant;
  }

  void checkFinite(SolveStatus status, const Record& record) const {
    if (isRefused(status))
      throw std::runtime_error(fmt::format("{}: the replay became non-finite at t = {:.6g} s",
                                           robot_.name, record.state.time));
  }

  /// Medians over the passes.
  Replay finish() {
    result_.passes = static_cast<int>(times_.size());
    std::vector<double> column;
    const auto median = [&](auto&& pick, std::size_t i) {
      column.clear();
      for (const std::vector<Times>& pass : times_) column.push_back(pick(pass[i]));
      return percentile(column, 0.5);
    };
    for (std::size_t i = 0; i < result_.rows.size(); ++i) {
      result_.stagesUs.push_back(median([](const Times& t) { return t.stages; }, i));
      result_.forwardUs.push_back(median([](const Times& t) { return t.forward; }, i));
      for (std::size_t s = 0; s < solvers_.size(); ++s) {
        Solved& solved = result_.solvers[s].records[i];
        solved.solveUs = median([&](const Times& t) { return t.solve[s]; }, i);
        solved.finishUs = median([&](const Times& t) { return t.finish[s]; }, i);
      }
    }
    return std::move(result_);
  }

  const Robot& robot_;
  Model model_;  ///< with the timestep of the record
  const Dataset& dataset_;
  Data data_;
  gdd::GoalCost cost_;
  const gdd::ControlLimits limits_;
  std::vector<std::unique_ptr<SolverUnderTest>> solvers_;
  std::vector<WarmStart> warm_;            ///< one a solver
  std::vector<std::vector<Times>> times_;  ///< by pass, by record
  TreeFactor factor_;
  VectorX control_, scratch_;
  Replay result_;
};

}  // namespace

Replay replay(const Robot& robot, const Dataset& dataset, const std::vector<std::string>& solvers,
              int passes, Progress& progress) {
  return Replayer(robot, dataset, solvers).run(passes, progress);
}

}  // namespace softgauss::app

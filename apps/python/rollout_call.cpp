// SPDX-License-Identifier: Apache-2.0
#include "apps/python/rollout_call.hpp"

#include <algorithm>
#include <chrono>
#include <future>

#include "apps/python/goals.hpp"
#include "softgauss/io/simulation/simulation_parts.hpp"

namespace softgauss::python {
namespace {

std::span<const double> spanOf(const Numbers& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

/// Of a run's row of an array (runs, n).
Eigen::Map<const VectorX> rowOf(const Numbers& array, long run) {
  return {array.data(run), array.shape(1)};
}

/// How many runs are meant: as many as are said, or as the first array has rows.
long runsOf(const RolloutArguments& a) {
  if (!a.runs.is_none()) return valueOf<long>(a.runs, "runs", "a whole number");
  if (a.states) return a.states->size();
  for (const py::object& array : {a.q0, a.v0, a.tau, a.targets})
    if (!array.is_none()) return py::len(array);
  for (const auto& [what, arrays] : {std::pair("parameters", a.parameters), {"pushes", a.pushes}})
    if (!arrays.is_none())
      for (const auto& [name, array] : namedOf(arrays, what))
        if (py::hasattr(array, "__len__")) return static_cast<long>(py::len(array));
  throw py::type_error("rollout: how many runs? expected runs=N, or an array with a row a run");
}

bool isNumber(const py::handle& x) { return !py::hasattr(x, "__len__"); }

}  // namespace

RolloutCall::RolloutCall(const Simulation& sim, const Rollout& rollout, long steps,
                         const RolloutArguments& a)
    : scene_(sim.scene()),
      model_(scene_.model),
      runs_(runsOf(a)),
      steps_(steps),
      progress_(a.progress),
      states_(a.states) {
  if (runs_ < 0 || steps < 0 || a.every < 1)
    throw py::value_error("rollout: found " + std::to_string(runs_) + " runs of " +
                          std::to_string(steps) + " steps, every " + std::to_string(a.every) +
                          ", expected none below 0, 0, 1");
  if (states_ && &states_->model() != &model_)
    throw py::value_error("rollout: states are of another simulation");
  if (states_ && states_->size() != runs_)
    throw py::value_error("rollout: states: found " + std::to_string(states_->size()) +
                          ", expected a state a run, " + std::to_string(runs_));
  readInputs(a);
  if (!a.parameters.is_none()) readParameters(a.parameters);
  readGoals(a.goals, a.targets);
  if (!a.pushes.is_none()) readPushes(sim, a.pushes);
  makeOutputs(rollout, a);
}

void RolloutCall::readInputs(const RolloutArguments& a) {
  if (states_ && !(a.q0.is_none() && a.v0.is_none()))
    throw py::type_error("rollout: found q0 or v0 beside states, expected one or the other");
  if (!a.q0.is_none()) q0_ = numbersOf(a.q0, "q0", {runs_, model_.nq}, "(runs, nq)");
  if (!a.v0.is_none()) v0_ = numbersOf(a.v0, "v0", {runs_, model_.nv}, "(runs, nv)");
  if (a.tau.is_none()) return;
  const auto tau = py::array::ensure(a.tau);
  if (tau && tau.ndim() == 2)
    held_ = numbersOf(a.tau, "tau", {runs_, model_.nv}, "(runs, nv)");
  else
    tau_ = numbersOf(a.tau, "tau", {runs_, steps_, model_.nv}, "(runs, steps, nv)");
}

void RolloutCall::readParameters(const py::object& parameters) {
  std::vector<Numbers> columns;
  for (const auto& [name, array] : namedOf(parameters, "parameters")) {
    if (states_ && (name.starts_with("q:") || name.starts_with("v:")))
      throw py::value_error("rollout: parameter '" + name +
                            "': says where a run starts, and it goes on from states");
    parameters_.push_back(name);
    columns.push_back(isNumber(array)
                          ? numbersOf(array, "parameter '" + name + "'", {}, "()")
                          : numbersOf(array, "parameter '" + name + "'", {runs_}, "(runs,)"));
  }
  values_ = Numbers({runs_, static_cast<long>(columns.size())});
  for (std::size_t p = 0; p < columns.size(); ++p)
    for (long run = 0; run < runs_; ++run)
      values_.mutable_at(run, static_cast<long>(p)) = columns[p].data()[columns[p].ndim() * run];
}

void RolloutCall::readGoals(const py::object& goals, const py::object& targets) {
  const bool none =
      py::isinstance<py::sequence>(goals) && !py::isinstance<py::str>(goals) && py::len(goals) == 0;
  if (goals.is_none() || none) {
    if (!targets.is_none()) throw py::type_error("rollout: found targets without goals");
    return;
  }
  goals_ = goalText(goals);
  const io::GoalFile asked = parseGoals(goals_, "goals", scene_);
  if (targets.is_none()) return;
  const auto given = py::array::ensure(targets);
  const py::ssize_t wanted = given && given.ndim() == 2 ? given.shape(1) : 0;
  py::ssize_t known = 0;
  for (const auto& goal : asked.goals) {
    if (known >= wanted) break;
    known += static_cast<py::ssize_t>(targetOf(*goal).size());
  }
  targets_ = numbersOf(targets, "targets", {runs_, known}, "(runs, numbers of the first goals)");
  targetCount_ = known;
}

void RolloutCall::readPushes(const Simulation& sim, const py::object& pushes) {
  for (const auto& [link, array] : namedOf(pushes, "pushes")) {
    pushes_.push_back({link, numbersOf(array, "push on '" + link + "'", {runs_, 3}, "(runs, 3)")});
    Pushes().set(sim, link, Vector3::Zero());  // throws where there is no such link
  }
  if (!pushes_.empty()) acting_.resize(static_cast<std::size_t>(runs_));
}

void RolloutCall::makeOutputs(const Rollout& rollout, const RolloutArguments& a) {
  out_.every = a.every;
  const py::ssize_t rows = steps_ / a.every;
  const auto links = static_cast<py::ssize_t>(rollout.contactLinks().size());
  const std::map<std::string, std::pair<std::span<double> RolloutOutputs::*, py::ssize_t>> known = {
      {"q", {&RolloutOutputs::q, model_.nq}},
      {"v", {&RolloutOutputs::v, model_.nv}},
      {"a", {&RolloutOutputs::a, model_.nv}},
      {"tau", {&RolloutOutputs::tau, model_.nv}},
      {"contact_forces", {&RolloutOutputs::contactForces, 3 * links}}};
  for (const std::string& name : a.outputs) {
    const auto found = known.find(name);
    if (found == known.end())
      throw py::value_error("rollout: found the output '" + name +
                            "', expected some of q, v, a, tau, contact_forces");
    const auto [member, columns] = found->second;
    std::vector<py::ssize_t> shape = {runs_, rows, columns};
    if (name == "contact_forces") shape = {runs_, rows, links, 3};
    py::array_t<double> array(shape);
    out_.*member = {array.mutable_data(), static_cast<std::size_t>(array.size())};
    result_.arrays[name] = array;
  }
}

void RolloutCall::begin(RolloutRun& run) {
  if (states_) states_->giveTo(run.sim.parts(), run.index);
  if (!goals_.empty()) {
    py::ssize_t next = 0;
    for (gdd::Goal* goal : run.sim.goals.readText(goals_)) {
      if (next >= targetCount_) break;
      for (double* number : targetOf(*goal)) *number = targets_.data(run.index)[next++];
    }
  }
  if (held_.size() > 0) run.sim.input().tau = rowOf(held_, run.index);
  for (const Push& push : pushes_)
    acting_[static_cast<std::size_t>(run.index)].set(run.sim, push.link,
                                                     rowOf(push.force, run.index));
}

void RolloutCall::end(RolloutRun& run) {
  if (states_) states_->takeFrom(run.sim.parts(), run.index);
  if (!acting_.empty()) acting_[static_cast<std::size_t>(run.index)] = {};
}

RolloutHooks RolloutCall::hooks() {
  RolloutHooks hooks;
  hooks.begin = [this](RolloutRun& run) { begin(run); };
  hooks.end = [this](RolloutRun& run) { end(run); };
  if (!acting_.empty())
    hooks.before = [this](RolloutRun& run) {
      acting_[static_cast<std::size_t>(run.index)].act(run.sim);
    };
  return hooks;
}

Runs RolloutCall::run(Rollout& rollout) {
  RolloutInputs in{.runs = runs_,
                   .steps = steps_,
                   .q0 = spanOf(q0_),
                   .v0 = spanOf(v0_),
                   .tau = spanOf(tau_),
                   .parameters = parameters_,
                   .values = spanOf(values_)};
  RolloutHooks hooks = this->hooks();
  std::atomic<bool> stop = false;
  std::atomic<long> done = 0;
  hooks.stop = &stop;
  hooks.progress = [&](long runs, long) { done = runs; };

  std::vector<RunOutcome> outcomes;
  {
    const py::gil_scoped_release release;
    auto work = std::async(std::launch::async, [&] { return rollout.run(in, out_, hooks); });
    try {
      while (work.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
        const py::gil_scoped_acquire lock;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (!progress_.is_none()) progress_(done.load(), runs_);
      }
    } catch (...) {
      stop = true;
      work.wait();
      throw;
    }
    outcomes = work.get();
  }
  if (!progress_.is_none()) progress_(runs_, runs_);
  result_.steps = py::array_t<long>(runs_);
  for (long run = 0; run < runs_; ++run) {
    const RunOutcome& outcome = outcomes[static_cast<std::size_t>(run)];
    result_.status.push_back(statusName(outcome.status));
    result_.failure.push_back(outcome.failure);
    result_.steps.mutable_at(run) = outcome.steps;
  }
  return std::move(result_);
}

}  // namespace softgauss::python

// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/study.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "apps/shared/cpu_time.hpp"
#include "apps/shared/progress.hpp"
#include "softgauss/engine/dynamics/energy.hpp"

namespace softgauss::app {
namespace {

int stepsOf(double h) { return static_cast<int>(std::lround(kPeriod / h)); }

double overshoot(const Model& model, const State& state) {
  double most = 0.0;
  for (const JointRange& range : model.ranges) {
    const double q = state.q[model.bodies[range.body].q];
    most = std::max({most, range.lower - q, q - range.upper});
  }
  return most;
}

}  // namespace

double simulatedOf(const Problem& problem) {
  return problem.windows * problem.windowPeriods * kPeriod;
}

double mostTime(const Problem& problem, const StudyOptions& options) {
  return options.mostSeconds / simulatedOf(problem);
}

Study::Study(const Problem& problem, StudyOptions options) : problem_(problem), options_(options) {}

State Study::initialState(const Model& model) const {
  State state(model);
  if (problem_.start) problem_.start(model, state);
  return state;
}

VectorX Study::force(const Model& model, double time) const {
  VectorX tau = VectorX::Zero(model.nv);
  if (problem_.force) problem_.force(model, time, tau);
  return tau;
}

/// States at the ends of periods; ends early where one is not finite, time is up, or the user
/// wishes to end.
std::vector<State> Study::run(EngineUnderTest& tested, const State& start, int periods, int steps,
                              Budget& budget, Watch* watch) const {
  std::vector<State> samples;
  tested.start(start);
  for (int k = 0; k < periods; ++k) {
    const double time = start.time + k * kPeriod;
    const VectorX tau = force(tested.model(), time);
    const int atOnce = watch ? 1 : steps;
    bool finite = true;
    for (int done = 0; finite && done < steps; done += atOnce) {
      const double begin = cpuSeconds();
      finite = tested.advance(tau, atOnce);
      budget.spent += cpuSeconds() - begin;
      if (!watch || !finite) continue;
      watch->overlap = std::max(watch->overlap, tested.deepestOverlap());
      watch->overshoot = std::max(watch->overshoot, overshoot(tested.model(), tested.state()));
    }
    if (!finite || budget.exceeded() || interrupted()) break;
    samples.push_back(tested.state());
    samples.back().time = time + kPeriod;
  }
  return samples;
}

/// The reference after kPeriod/kMostSteps, twice that, … the longest step.
std::vector<State> Study::firstSteps(const References& of, const State& start) const {
  std::vector<State> states;
  const int parts = std::max(1, of.fineSteps / kMostSteps);
  const auto tested = makeEngine(problem_, of.fine, kPeriod / (kMostSteps * parts));
  tested->start(start);
  const VectorX tau = force(tested->model(), start.time);
  for (int done = 0, k = 1; k <= kMostSteps / kFewestContactSteps; done = k, k *= 2) {
    if (!tested->advance(tau, (k - done) * parts)) break;
    states.push_back(tested->state());
  }
  return states;
}

double Study::oneStep(EngineUnderTest& tested, double h) const {
  LinkPoses pose(tested.model()), reference(tested.model());
  const std::size_t k = std::lround(std::log2(h * kMostSteps / kPeriod));
  double sum = 0.0;
  for (const Window& window : windows()) {
    tested.start(window.start);
    if (k >= window.first.size() || !tested.advance(force(tested.model(), window.start.time), 1))
      return kInfinity;
    pose.set(tested.state());
    reference.set(window.first[k]);
    sum += std::pow(pose.against(reference).total, 2);
  }
  return std::sqrt(sum / static_cast<double>(windows().size()));
}

bool Study::prepare(const Method& method) {
  const References wanted = referencesFor(problem_, method);
  for (current_ = 0; current_ < references_.size(); ++current_)
    if (references_[current_].of == wanted) break;
  if (current_ == references_.size()) references_.push_back(makeReference(wanted));
  return !windows().empty();
}

Study::Reference Study::makeReference(const References& of) const {
  Reference reference;
  reference.of = of;
  const auto fine = makeEngine(problem_, of.fine, kPeriod / of.fineSteps);
  const auto coarse = makeEngine(problem_, of.coarse, kPeriod / of.coarseSteps);
  const Model& model = fine->model();

  // Where windows start: on the motion of the coarser one.
  Budget any;
  std::vector<State> starts{initialState(model)};
  if (problem_.windows > 1) {
    const std::vector<State> states =
        run(*coarse, starts.front(), problem_.periods, of.coarseSteps, any);
    if (static_cast<int>(states.size()) < problem_.periods) return reference;
    starts.clear();
    for (int w = 0; w < problem_.windows; ++w)
      starts.push_back(states[(w + 1) * (problem_.periods - 1) / problem_.windows]);
  }
  LinkPoses a(model), b(model);
  std::vector<Window> windows;
  double sum = 0.0;
  int count = 0;
  for (const State& start : starts) {
    Window window;
    window.start = start;
    if (problem_.exact) {
      for (int k = 1; k <= problem_.windowPeriods; ++k) {
        State state = start;
        state.time = start.time + k * kPeriod;
        problem_.exact(model, state.time, state);
        window.samples.push_back(state);
      }
    } else {
      window.samples = run(*fine, start, problem_.windowPeriods, of.fineSteps, any);
      const std::vector<State> other =
          run(*coarse, start, problem_.windowPeriods, of.coarseSteps, any);
      if (static_cast<int>(std::min(window.samples.size(), other.size())) < problem_.windowPeriods)
        return reference;
      for (int k = 0; k < problem_.windowPeriods; ++k) {
        a.set(window.samples[k]);
        b.set(other[k]);
        sum += std::pow(a.against(b).total, 2);
        ++count;
      }
    }
    if (problem_.contact) window.first = firstSteps(of, start);
    windows.push_back(std::move(window));
  }
  reference.windows = std::move(windows);
  reference.error = count > 0 ? std::sqrt(sum / count) : 0.0;
  return reference;
}

Result Study::measure(const Method& method, double h) {
  Result result;
  result.problem = problem_.name;
  result.method = method;
  result.h = h;
  result.referenceError = referenceError();
  const auto tested = makeEngine(problem_, method, h);
  const Model& model = tested->model();
  LinkPoses pose(model), reference(model);
  Kinematics kinematics(model);
  const auto energy = [&](const State& state, Momentum& momentum) {
    computeKinematics(model, state, kinematics);
    momentum = computeMomentum(model, kinematics);
    return computeEnergy(model, kinematics, state.q, state.v);
  };
  double sum = 0.0, turned = 0.0, kinetic = 0.0;
  Momentum own, right;
  Vector3 change = Vector3::Zero(), most = Vector3::Zero();  // of linear and angular momentum
  int count = 0;
  Budget budget{options_.mostSeconds};
  Watch watch;
  for (const Window& window : windows()) {
    const std::vector<State> states =
        run(*tested, window.start, problem_.windowPeriods, stepsOf(h), budget, &watch);
    if (states.size() < window.samples.size()) {
      const bool late = budget.exceeded();
      result.error = result.orientation =
          late ? std::numeric_limits<double>::quiet_NaN() : kInfinity;
      result.time = late ? mostTime(problem_, options_) : kInfinity;
      return result;
    }
    for (std::size_t k = 0; k < states.size(); ++k) {
      pose.set(states[k]);
      reference.set(window.samples[k]);
      const PoseError error = pose.against(reference);
      sum += error.total * error.total;
      turned += error.orientation * error.orientation;
      ++count;
      const Energy there = energy(states[k], own), wanted = energy(window.samples[k], right);
      kinetic = std::max(kinetic, wanted.kinetic);
      result.energyDrift = std::max(result.energyDrift, std::abs(there.total() - wanted.total()));
      change = change.cwiseMax(
          Vector3((own.linear - right.linear).norm(), (own.angular - right.angular).norm(), 0.0));
      most = most.cwiseMax(Vector3(right.linear.norm(), right.angular.norm(), 0.0));
    }
  }
  result.penetration = watch.overlap;
  result.overshoot = watch.overshoot;
  result.time = budget.spent / simulatedOf(problem_);
  // The reference is known after these steps.
  if (problem_.contact && std::has_single_bit(static_cast<unsigned>(stepsOf(h))))
    result.oneStep = oneStep(*tested, h);
  result.error = std::sqrt(sum / count);
  result.orientation = std::sqrt(turned / count);
  result.energyDrift = kinetic > 0.0 ? result.energyDrift / kinetic : 0.0;
  for (int i = 0; i < 2; ++i)
    if (most[i] > 0.0) result.momentumDrift = std::max(result.momentumDrift, change[i] / most[i]);
  return result;
}

void Study::measureTimes(std::vector<Result>& results) {
  std::vector<std::pair<Result*, std::unique_ptr<EngineUnderTest>>> again;
  for (Result& r : results)
    if (options_.repeats > 0 && std::isfinite(r.error) &&
        r.time * simulatedOf(problem_) <= options_.longRun) {
      again.emplace_back(&r, makeEngine(problem_, r.method, r.h));
      r.time = kInfinity;
    }
  for (int repeat = 0; repeat < options_.repeats; ++repeat) {
    for (const auto& [result, tested] : again) {
      Budget budget;
      int rounds = 0;
      do {
        for (const Window& window : windows())
          run(*tested, window.start, problem_.windowPeriods, stepsOf(result->h), budget);
        ++rounds;
      } while (budget.spent < options_.minTime && rounds < 1000);
      result->time = std::min(result->time, budget.spent / (rounds * simulatedOf(problem_)));
    }
  }
}

TrialRun Study::tryOut(const Method& method, double h, int periods, double mostSeconds) const {
  TrialRun result;
  const auto tested = makeEngine(problem_, method, h);
  Budget budget{mostSeconds};
  for (const Window& window : windows()) {
    const std::vector<State> states = run(*tested, window.start, periods, stepsOf(h), budget);
    result.samples.insert(result.samples.end(), states.begin(), states.end());
    result.seconds = budget.spent;
    result.late = budget.exceeded();
    if (static_cast<int>(states.size()) < periods) return result;
  }
  result.finite = true;
  return result;
}

}  // namespace softgauss::app

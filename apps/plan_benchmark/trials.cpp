// SPDX-License-Identifier: Apache-2.0
#include "apps/plan_benchmark/trials.hpp"

#include <algorithm>
#include <cmath>

#include "apps/shared/cpu_time.hpp"
#include "apps/shared/interrupt.hpp"
#include "apps/shared/wall_clock.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/io/plan_task.hpp"
#include "softgauss/io/simulation/scene.hpp"

namespace softgauss::app {
namespace {

using namespace planning;

std::vector<VectorX> randomStart(const Model& model, int knots, double spread, unsigned seed) {
  NormalNumbers random(seed);
  std::vector<VectorX> a(static_cast<std::size_t>(knots), VectorX::Zero(model.nv));
  for (VectorX& knot : a)
    for (double& x : knot) x = spread * random.next();
  return a;
}

PlanOptions feasibleOptions(PlanMethod method, const TrialChoice& choice) {
  PlanOptions options;
  options.feasible = choice.iterations;
  if (method == PlanMethod::ilqr) {
    options.inPhaseF.goalDirected = false;
    options.inPhaseF.lengths = 16;  // to 1e-6
  }
  return options;
}

/// CPU time of this thread; where others help, wall time [s].
double secondsNow(const io::PlanTask& task) {
  return task.steps.threads > 1 ? secondsSince(Clock::time_point{}) : cpuSeconds();
}

/// Of phase I, on the contacts on which it begins and from rest: what many iterations take beyond
/// few, each with one pass in the end. The least of some repeats.
double iterationSeconds(Planner& planner, const io::PlanTask& task, const State& start) {
  constexpr int kFew = 5, kMany = 25, kRepeats = 5;
  if (task.contacts) planner.setContacts(task.contacts->contacts);
  const auto seconds = [&](int iterations) {
    PlanOptions options = task.options;
    options.infeasible = options.passEvery = iterations;
    options.feasible = 0;
    const double begin = secondsNow(task);
    planner.solve(start, options);
    return secondsNow(task) - begin;
  };
  double few = kInfinity, many = kInfinity;
  for (int i = 0; i < kRepeats; ++i)
    few = std::min(few, seconds(kFew)), many = std::min(many, seconds(kMany));
  return (many - few) / (kMany - kFew);
}

/// Costs by iterations, which go on where a stage counts its own anew.
struct Curve {
  std::vector<std::pair<int, double>> points;
  int before = 0;
  void add(int iteration, double cost) {
    const int last = points.empty() ? 0 : points.back().first;
    if (before + iteration < last) before = last;
    points.emplace_back(before + iteration, cost);
  }
};

}  // namespace

std::string planMethodName(PlanMethod method) {
  switch (method) {
    case PlanMethod::ailqr:
      return "AILQR";
    case PlanMethod::feasible:
      return "phase F";
    case PlanMethod::ilqr:
      return "iLQR";
  }
  return "";
}

std::vector<double> PlanTrials::costs() const {
  std::vector<double> sorted;
  for (const PlanTrial& trial : trials) sorted.push_back(trial.cost);
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

int PlanTrials::within(double best, double share) const {
  return static_cast<int>(std::count_if(trials.begin(), trials.end(), [&](const PlanTrial& t) {
    return t.cost <= best + share * std::abs(best);
  }));
}

PlanTrials runTrials(const std::filesystem::path& file, PlanMethod method,
                     const TrialChoice& choice) {
  const auto scene = loadScene(file);
  io::PlanTask task = io::readPlanTask(file, scene->model, scene->initial);
  task.steps.threads = choice.threads;
  Planner planner(scene->model, task.steps, [](const Model& model) {
    return std::make_unique<collision::SceneContacts>(model);
  });
  task.setCosts(planner);
  PlanTrials all{
      file.stem().string(), scene->model.nv, task.steps.knots, task.best, method, 0.0, {}};
  if (method == PlanMethod::ailqr) all.iteration = iterationSeconds(planner, task, scene->initial);
  for (int i = 0; i < choice.starts && !interrupted(); ++i) {
    const auto start = randomStart(scene->model, task.steps.knots, task.spread,
                                   choice.seed + static_cast<unsigned>(i));
    Curve curve;
    planner.progress = [&](const MotionPlan& now) {
      if (planner.feasible().hasTrajectory())
        curve.add(now.iterations, planner.feasible().trajectory().cost);
      return !interrupted();
    };
    const double begin = secondsNow(task);
    const MotionPlan& plan =
        method == PlanMethod::ailqr
            ? task.solve(planner, scene->initial, start)
            : task.solveFeasible(planner, scene->initial, feasibleOptions(method, choice), start);
    PlanTrial& trial = all.trials.emplace_back();
    const bool found = plan.status != PlanStatus::infeasible && plan.status != PlanStatus::refused;
    trial.cost = found ? plan.cost : kInfinity;
    trial.rootForce = plan.rootForce, trial.gap = plan.gap;
    trial.iterations = plan.iterations;
    trial.seconds = secondsNow(task) - begin;
    if (found) curve.add(plan.iterations, plan.cost);
    trial.curve = std::move(curve.points);
    trial.status = planStatusName(plan.status);
  }
  return all;
}

}  // namespace softgauss::app

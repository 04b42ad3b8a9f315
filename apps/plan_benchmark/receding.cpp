// SPDX-License-Identifier: Apache-2.0
#include "apps/plan_benchmark/receding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/shared/interrupt.hpp"
#include "apps/shared/wall_clock.hpp"
#include "softgauss/io/nearest_rank.hpp"
#include "softgauss/io/simulation/plan_control.hpp"
#include "softgauss/io/simulation/simulation.hpp"

namespace softgauss::app {
namespace {

constexpr double kPushSeconds = 0.1;

int floatingBody(const Model& model) {
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[static_cast<std::size_t>(b)].joint == JointKind::floating) return b;
  return -1;
}

/// Whether a robot moves in a plane: some link of it slides along the world, and nobody pulls
/// there.
bool slides(const Model& model) {
  return std::ranges::any_of(model.bodies, [&](const Body& body) {
    return body.parent == 0 && body.joint == JointKind::prismatic &&
           !model.dofs[static_cast<std::size_t>(body.v)].actuated;
  });
}

/// A push at the root, or none.
struct Push {
  int body = -1;
  double start = 0.0;
  Vector3 force = Vector3::Zero();

  bool actsAt(double time) const {
    return body >= 0 && time >= start && time < start + kPushSeconds;
  }
};

Push randomPush(const Model& model, const RecedingChoice& choice, double planned,
                planning::NormalNumbers& random) {
  Push push;
  push.body = floatingBody(model);
  push.start = planned + 0.5 * random.uniform();
  const double angle = 2.0 * std::numbers::pi * random.uniform();
  push.force = model.totalMass() * choice.push / kPushSeconds *
               Vector3(std::cos(angle), std::sin(angle), 0.0);
  return push;
}

/// Where scalar joints start, within their ranges.
std::vector<std::pair<std::string, double>> disturbed(const Scene& scene, double deviation,
                                                      planning::NormalNumbers& random) {
  std::vector<std::pair<std::string, double>> q0;
  const Model& model = scene.model;
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[static_cast<std::size_t>(b)];
    if (body.dofs != 1) continue;
    double q = scene.initial.q[body.q] + deviation * random.next();
    for (const JointRange& range : model.ranges)
      if (range.body == b) q = std::clamp(q, range.lower, range.upper);
    q0.emplace_back(model.jointNames[static_cast<std::size_t>(b)], q);
  }
  return q0;
}

/// Acts until `choice.after` seconds after the push.
RecedingRun act(Simulation& sim, PlanControl& control, const Push& push,
                const RecedingChoice& choice, RecedingRuns& all) {
  RecedingRun run;
  control.solve();
  control.attach(sim.controller());
  control.begin(sim.state());
  run.planned = control.finalPlanned();
  const double until = push.start + kPushSeconds + choice.after;
  bool refused = false;
  for (int ticks = 0; sim.time() < until && !refused && !interrupted();) {
    control.update(sim.state());
    if (control.report().ticks > ticks) all.tickMs.push_back(1e3 * control.report().last);
    ticks = control.report().ticks;
    sim.input().wrenches.clear();
    if (push.actsAt(sim.time()))
      sim.input().wrenches.push_back({push.body, {Vector3::Zero(), push.force}});
    const Clock::time_point start = Clock::now();
    refused = isRefused(sim.step());
    all.stepUs.push_back(1e6 * secondsSince(start));
  }
  run.failedTicks = control.report().failed;
  run.final = control.cost(sim.state()).final;
  run.carriedOut = !refused && !control.isLost(run.final);
  return run;
}

double percentile(const std::vector<double>& sorted, double share) {
  return sorted.empty() ? 0.0 : sorted[io::nearestRank(share, sorted.size())];
}

}  // namespace

int RecedingRuns::carriedOut() const {
  return static_cast<int>(
      std::count_if(runs.begin(), runs.end(), [](const RecedingRun& r) { return r.carriedOut; }));
}

RecedingRuns runReceding(const std::filesystem::path& file, const RecedingChoice& choice) {
  SimulationOptions options;
  options.timestep = choice.timestep;
  const auto scene = loadScene(file, options);
  RecedingRuns all;
  all.task = file.stem().string();
  all.dofs = scene->model.nv;
  all.floats = floatingBody(scene->model) >= 0;
  all.slides = slides(scene->model);
  for (int i = 0; i < choice.runs && !interrupted(); ++i) {
    planning::NormalNumbers random(choice.seed + static_cast<unsigned>(i));
    options.q0.clear();
    if (!all.floats && !all.slides) options.q0 = disturbed(*scene, choice.disturbed, random);
    Simulation sim = Simulation::load(file, options);
    io::PlanTask task = io::readPlanTask(file, sim.model(), sim.scene().initial);
    task.steps.threads = choice.threads;
    PlanControl control(sim.scene(), std::move(task), true);
    if (all.slides)
      for (double& v : sim.state().v) v += choice.disturbed * random.next();
    const Push push = randomPush(sim.model(), choice, control.duration(), random);
    all.runs.push_back(act(sim, control, push, choice, all));
  }
  std::sort(all.tickMs.begin(), all.tickMs.end());
  std::sort(all.stepUs.begin(), all.stepUs.end());
  return all;
}

std::string recedingTable(const std::vector<RecedingRuns>& all, const RecedingChoice& choice) {
  std::string out = fmt::format("{:<16}{:>4}  {:<18}{:>10}{:>10}{:>10}{:>8}{:>10}{:>9}\n", "task",
                                "dof", "disturbed by", "ends well", "tick p50", "p99.9", "failed",
                                "step p50", "p99.9 us");
  for (const RecedingRuns& r : all) {
    int failed = 0;
    for (const RecedingRun& run : r.runs) failed += run.failedTicks;
    out += fmt::format(
        "{:<16}{:>4}  {:<18}{:>7}/{:<2}{:>7.2f} ms{:>7.2f} ms{:>8}{:>10.1f}{:>9.1f}\n", r.task,
        r.dofs,
        r.floats ? fmt::format("{:g} m/s", choice.push)
                 : fmt::format("{:g} {} at first", choice.disturbed, r.slides ? "m/s" : "rad"),
        r.carriedOut(), r.runs.size(), percentile(r.tickMs, 0.5), percentile(r.tickMs, 0.999),
        failed, percentile(r.stepUs, 0.5), percentile(r.stepUs, 0.999));
  }
  return out;
}

}  // namespace softgauss::app

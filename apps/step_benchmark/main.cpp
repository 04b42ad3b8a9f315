// SPDX-License-Identifier: Apache-2.0
/// step_benchmark: µs per step and per stage, one flat `scene.stage.us value` line per figure.
///
/// Every scene is warmed up and its state saved; it is restored every 50 steps. The figures are
/// medians over the steps, and over five repetitions.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/shared/median.hpp"
#include "apps/shared/wall_clock.hpp"
#include "apps/step_benchmark/crowds.hpp"
#include "apps/step_benchmark/in_turn.hpp"
#include "apps/step_benchmark/ladder.hpp"
#include "apps/step_benchmark/landscape.hpp"
#include "apps/step_benchmark/pictures.hpp"
#include "apps/step_benchmark/scaling.hpp"
#include "apps/step_benchmark/scenes.hpp"

namespace {

using namespace softgauss;
using namespace softgauss::app;

constexpr int kWarmUpSteps = 500;
constexpr int kTimedSteps = 50;
constexpr int kPieces = 20;
constexpr int kRepetitions = 5;

/// As --view does it.
void record(Scene& scene) {
  computeStages(scene.model, {}, scene.state, *scene.data, scene.contacts.get());
  scene.recording =
      std::make_unique<io::Recording>(scene.model, scene.controller->goals,
                                      gdd::GoalContext{scene.model, scene.state, *scene.data});
  const int steps = kPieces * kTimedSteps;
  scene.recording->reserve(steps, steps * scene.model.options.timestep);
}

/// Records steps that were taken from `before` and says how long one takes [µs].
class Recorder {
 public:
  void addStep(Scene& scene, const State& before) {
    row_.time = time_ += scene.model.options.timestep;
    row_.q = before.q;
    row_.v = before.v;
    row_.u = scene.data->forces.tau;
    const auto start = app::Clock::now();
    scene.recording->addStep(row_, *scene.data);
    seconds_ += app::secondsSince(start);
    ++steps_;
  }
  double mean() const { return 1e6 * seconds_ / steps_; }

 private:
  io::StepRecord row_;
  double time_ = 0.0, seconds_ = 0.0;
  int steps_ = 0;
};

/// Medians over the steps become the counters of the benchmark: a step that another program has
/// interrupted does not count.
void timeScene(benchmark::State& state, const std::function<std::unique_ptr<Scene>()>& make,
               int warmUp) {
  const std::unique_ptr<Scene> scene = make();
  scene->data->timed = true;
  for (int i = 0; i < warmUp; ++i) scene->step();
  const State saved = scene->state;
  std::map<std::string, std::vector<double>> values;
  Recorder recorder;
  State before;
  for (auto _ : state) {
    for (int i = 0; i < kPieces * kTimedSteps; ++i) {
      if (i % kTimedSteps == 0) scene->state = saved;
      if (scene->recording) before = scene->state;
      const auto start = app::Clock::now();
      scene->step();
      const double seconds = app::secondsSince(start);
      if (scene->recording) recorder.addStep(*scene, before);
      const StepStats& stats = scene->data->stats;
      values["step.us"].push_back(1e6 * seconds);
      values["kinematics.us"].push_back(1e6 * stats.times.kinematics);
      values["collision.us"].push_back(1e6 * stats.times.collision);
      values["rows.us"].push_back(1e6 * stats.times.rows);
      values["forward.us"].push_back(1e6 * stats.times.solve);
      values["integrate.us"].push_back(1e6 * stats.times.integrate);
      values["contacts"].push_back(stats.contacts);
      values["constraints"].push_back(stats.rows);
      values["iterations"].push_back(stats.iterations);
      values["growths"].push_back(static_cast<double>(scene->data->contacts.growths));
      if (scene->controller) {
        values["gdd.us"].push_back(1e6 * scene->controller->solveTime);
        values["gdd_iterations"].push_back(scene->controller->report.iterations);
      }
    }
    state.SetIterationTime(1e-6 * median(values["step.us"]));
  }
  double bytes = 0.0;
  for (const EffectUse& use : effectUse(scene->model, *scene->data, scene->contacts.get()))
    bytes += static_cast<double>(use.bytes);
  values["effects.bytes"] = {bytes};
  // One step in eight makes a frame too, so here the mean counts.
  if (scene->recording) values["record.us"] = {recorder.mean()};
  for (auto& [name, column] : values) state.counters[name] = median(column);
}

/// Collects the repetitions' counters and prints their medians.
class FlatReporter final : public benchmark::BenchmarkReporter {
 public:
  explicit FlatReporter(nlohmann::ordered_json& json) : json_(json) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    std::map<std::string, std::vector<double>> values;
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      for (const auto& [name, counter] : run.counters) values[name].push_back(counter.value);
    }
    const std::string scene = runs.front().run_name.function_name;
    for (auto& [name, column] : values) {
      const double value = median(column);
      json_[scene + "." + name] = value;
      fmt::print("{}.{} {:.4g}\n", scene, name, value);
    }
    std::fflush(stdout);
  }

 private:
  nlohmann::ordered_json& json_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("µs per step and stage; one line per figure");
  std::string filter = ".", file, pictures, robots = "data/robots";
  app.add_option("--filter", filter, "regular expression of scene names");
  app.add_option("--json", file, "write the figures to this file too");
  app.add_option("--pictures", pictures,
                 "draw the ladder and the scaling into this folder, with gnuplot");
  app.add_option("--robots", robots, "folder of humanoid.urdf, hand.urdf, arm.urdf")
      ->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, argc, argv);

  const auto add = [&](const std::string& name, int warmUp,
                       std::function<std::unique_ptr<Scene>()> make) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [=](benchmark::State& s) { timeScene(s, make, warmUp); })
        ->Iterations(1)
        ->UseManualTime()
        ->Repetitions(kRepetitions);
  };
  add("humanoid_moving", 250, [&] { return makeRobot(robots, "humanoid", true); });
  add("humanoid_rest", 2000, [&] { return makeRobot(robots, "humanoid", true); });
  add("hand", kWarmUpSteps, [&] { return makeRobot(robots, "hand", true); });
  add("arm", kWarmUpSteps, [&] { return makeRobot(robots, "arm", false); });
  struct Reaching {
    const char *robot, *link;
    Vector3 target;
  };
  for (const auto& [robot, link, target] : {Reaching{"humanoid", "right_hand", {0.45, -0.25, 1.10}},
                                            Reaching{"hand", "index_tip", {0.25, 0.08, 0.06}},
                                            Reaching{"arm", "hand", {0.5, 0.3, 0.5}}})
    for (const bool recorded : {false, true})
      add(fmt::format("{}_gdd{}", robot, recorded ? "_recorded" : ""), 100, [=] {
        const std::string name = robot;
        auto scene = makeRobot(robots, name, name != "arm");
        addReach(*scene, link, target);
        if (recorded) record(*scene);
        return scene;
      });
  add("chain100", kWarmUpSteps, [] { return makeChain(100); });
  for (const Rung& rung : ladder(robots)) add("ladder_" + rung.name, 0, rung.make);
  for (const Rung& rung : scaling(robots)) add("scaling_" + rung.name, 10, rung.make);

  try {
    nlohmann::ordered_json json;
    FlatReporter reporter(json);
    benchmark::RunSpecifiedBenchmarks(&reporter, filter);
    std::map<std::string, double> figures;
    for (const auto& timed : {ladderInTurn, scalingInTurn})
      for (const auto& [name, value] : timed(robots, filter)) figures[name] = value;
    figures.merge(landscapeFigures(filter));
    for (const auto& [what, exponent] : exponents(figures))
      figures["scaling_" + what + ".exponent"] = exponent;
    for (const auto& [name, value] : figures) fmt::print("{} {:.4g}\n", name, value);
    figures.merge(crowdFigures(robots, filter));
    for (const auto& [name, value] : figures) json[name] = value;
    if (!pictures.empty()) drawPictures(figures, pictures);
    if (!file.empty()) std::ofstream(file) << json.dump(2) << '\n';
  } catch (const std::exception& error) {
    fmt::print(stderr, "step_benchmark: {}\n", error.what());
    return 2;
  }
  return 0;
}

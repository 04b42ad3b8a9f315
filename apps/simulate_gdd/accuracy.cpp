// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/shared/cpu_time.hpp"
#include "apps/shared/run_choice.hpp"
#include "apps/simulate_gdd/outside_input.hpp"
#include "apps/simulate_gdd/progress.hpp"

namespace softgauss::app {
namespace {

constexpr double kPeriod = 0.032;  // [s]
constexpr int kMostSamples = 2000;
constexpr double kMostRows = 1e6;  // of a table in a trial

/// Runs the scene with other options from its start, and shows how far it is.
class Trials {
 public:
  Trials(const SimulateOptions& options, const Scene& scene)
      : options_(options),
        scene_(scene),
        outside_(options, scene),
        progress_(options.duration, options.quiet) {}
  ~Trials() { progress_.clear(); }

  TrialScene over(double simulated) {
    const int periods = periodsOf(simulated);
    TrialScene trial;
    trial.model = &scene_.model;
    trial.period = simulated / periods;
    trial.simulated = simulated;
    trial.longestStep = std::min(trial.period, longestStepFor(scene_.model));
    trial.run = [this, periods, period = trial.period](const Setting& setting, double mostSeconds) {
      Model model = scene_.model;
      setting.setOptions(period, model.options);
      ++count_;
      what_ = setting.text(period);
      return run(std::move(model), periods, setting.steps, mostSeconds);
    };
    return trial;
  }

 private:
  int periodsOf(double simulated) const;
  TrialRun run(Model model, int periods, int steps, double mostSeconds);

  const SimulateOptions& options_;
  const Scene& scene_;
  const OutsideInput outside_;
  RunProgress progress_;
  const double begin_ = cpuSeconds();
  int count_ = 0;
  std::string what_;  ///< is tried
};

/// Where the rows of a table come regularly they end periods, so that few steps are cut at one.
int Trials::periodsOf(double simulated) const {
  const double spacing = outside_.rowSpacing();
  const double rows = spacing > 0.0 ? simulated / spacing : 0.0;
  if (rows >= 1.0 && rows <= kMostRows && std::abs(rows - std::round(rows)) < 1e-6)
    return static_cast<int>(std::lround(rows)) *
           static_cast<int>(std::ceil(spacing / kPeriod - 1e-9));
  return std::max(1, static_cast<int>(std::lround(simulated / kPeriod)));
}

TrialRun Trials::run(Model model, int periods, int steps, double mostSeconds) {
  collision::SceneContacts contacts(model);
  Data data(model);
  State state = scene_.initial;
  Input input;
  gdd::GoalDirectedController controller(model);
  setUp(options_, scene_, controller);

  TrialRun result;
  result.touches = false;
  const auto takeStep = [&] {
    outside_.at(model, state, data.kinematics, input);
    const bool taken = !isRefused(controller.goals.empty()
                                      ? step(model, input, state, data, &contacts)
                                      : controller.step(model, input, state, data, &contacts));
    for (const RowKind kind : {RowKind::jointLimit, RowKind::pyramid, RowKind::ellipticCone})
      result.touches = result.touches || data.constraints.active().has(kind);
    return taken;
  };
  const int every = (periods + kMostSamples - 1) / kMostSamples;
  for (int k = 0; k < periods; ++k) {
    progress_.showTrial(count_, what_, static_cast<double>(k) / periods, cpuSeconds() - begin_);
    const double begin = cpuSeconds();
    for (int i = 0; i < steps; ++i) {
      if (!outside_.inParts(model, state, takeStep)) {
        result.lostAt = state.time;
        return result;
      }
    }
    result.seconds += cpuSeconds() - begin;
    result.late = result.seconds > mostSeconds;
    if (result.late) return result;
    // The last period's end is the run's.
    if ((periods - 1 - k) % every == 0) result.samples.push_back(state);
  }
  result.finite = true;
  return result;
}

/// Why nothing can be promised.
std::string refusal(const RunChoice& run, double accuracy, double duration) {
  const Choice& choice = run.choice;
  if (run.growth.chaotic)
    return fmt::format(
        "cannot be promised: in a trial of {:g} s errors grow e-fold every {:.2g} s, which is "
        "chaos, and {:g} s are too dear to be tried",
        run.tried, 1.0 / run.growth.rate, duration);
  if (choice.referenced) return "is reached by none of the settings that were tried";
  if (choice.error == kInfinity && !choice.late && choice.lostAt < kInfinity)
    return fmt::format(
        "cannot be promised: accurate runs of the scene become non-finite, the first at t = {:.6g} "
        "s. A shorter --duration, more joint damping or smaller forces may do",
        choice.lostAt);
  if (choice.error == kInfinity)
    return fmt::format(
        "cannot be promised: no two accurate runs of {:g} s came to their end within {:g} s of CPU "
        "time",
        run.tried, run.whole ? kTrialCpuSeconds : kShortCpuSeconds);
  return fmt::format(
      "cannot be promised: the two accurate runs of {:g} s that are nearest differ by {:.2g} m, "
      "and {:.2g} m would do. Motion with impacts or chaos spreads every error; a shorter "
      "--duration or a larger error may do",
      run.tried, choice.error, kReferenceShare * accuracy);
}

/// What was tried, and what that says of the end.
std::string reach(const RunChoice& run, double duration) {
  if (run.whole)
    return fmt::format("estimated error {:.2g} m over the whole run of {:g} s, {:.2g} m at its end",
                       run.choice.error, duration, run.atEnd);
  return fmt::format(
      "estimated error {:.2g} m over the first {:g} s, where it grows as t^{:.1f}: {:.2g} m at the "
      "end of {:g} s is what that leads to, and no promise, for a trial of the whole run would "
      "take "
      "more than {:g} s of CPU time",
      run.choice.error, run.tried, run.growth.power, run.atEnd, duration, kTrialCpuSeconds);
}

}  // namespace

std::string chooseAccuracy(const SimulateOptions& options, Scene& scene) {
  const double accuracy = *options.accuracy;
  Trials trials(options, scene);
  if (scene.model.options.sleep.enabled)
    throw AccuracyError(fmt::format(
        "--accuracy {:g}: cannot be promised: what sleeps is not followed, expected sleep: none",
        accuracy));
  const RunChoice run = chooseForRun(accuracy, options.duration,
                                     [&](double simulated) { return trials.over(simulated); });
  const Choice& choice = run.choice;
  if (!choice.found)
    throw AccuracyError(
        fmt::format("--accuracy {:g}: {}", accuracy, refusal(run, accuracy, options.duration)));
  choice.setting.setOptions(run.period, scene.model.options);
  return fmt::format(
      "accuracy {:g} m: {}; {}; {:.3g} s of CPU time per simulated second; {} trials took {:.2g} s",
      accuracy, choice.setting.text(run.period), reach(run, options.duration), choice.price,
      choice.trials, choice.trialSeconds);
}

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/shared/cpu_time.hpp"
#include "io/torque_table.hpp"

namespace softgauss::app {
namespace {

constexpr double kLongestTrial = 2.0;  // [s]
constexpr double kPeriod = 0.032;      // [s]

/// The scene with other options, from its start to the end of the trial.
TrialRun tryOut(const SimulateOptions& options, const Scene& scene, const Model& model, int periods,
                int steps, double mostSeconds) {
  collision::SceneContacts contacts(model);
  Data data(model);
  State state = scene.initial;
  Input input;
  io::WrenchSchedule wrenches = scene.schedule;
  gdd::GoalDirectedController controller(model);
  if (!options.passive && options.torques.empty()) controller.goals = makeGoals(options, scene);
  controller.solver = scene.gddSolver;
  controller.box = io::controlBox(model, scene.actuators);
  std::optional<io::TorqueTable> torques;
  if (!options.torques.empty()) torques = io::TorqueTable::read(options.torques, model);

  TrialRun result;
  for (int k = 0; k < periods; ++k) {
    const double begin = cpuSeconds();
    for (int i = 0; i < steps; ++i) {
      if (torques) torques->controlAt(state.time, input.tau);
      if (!wrenches.empty()) {
        computeKinematics(model, state, data.kinematics);
        wrenches.at(state.time, model.options.timestep, data.kinematics, input.wrenches);
      }
      if (isRefused(controller.goals.empty()
                        ? step(model, input, state, data, &contacts)
                        : controller.step(model, input, state, data, &contacts)))
        return result;
    }
    result.seconds += cpuSeconds() - begin;
    if (result.seconds > mostSeconds) return result;
    result.samples.push_back(state);
  }
  result.finite = true;
  return result;
}

}  // namespace

std::string chooseAccuracy(const SimulateOptions& options, Scene& scene) {
  const double accuracy = *options.accuracy;
  const double simulated = std::min(options.duration, kLongestTrial);
  const int periods = std::max(1, static_cast<int>(std::lround(simulated / kPeriod)));
  TrialScene trial;
  trial.model = &scene.model;
  trial.period = simulated / periods;
  trial.simulated = simulated;
  trial.longestStep = std::min(trial.period, longestStepFor(scene.model));
  trial.run = [&](const Setting& setting, double mostSeconds) {
    Model model = scene.model;
    setting.setOptions(trial.period, model.options);
    return tryOut(options, scene, model, periods, setting.steps, mostSeconds);
  };
  const Choice choice = chooseSetting(accuracy, trial);
  if (!choice.found)
    throw ModelError(
        {}, fmt::format("--accuracy {:g}", accuracy),
        choice.referenced
            ? "is reached by none of the settings that were tried"
            : fmt::format("cannot be promised: two accurate runs of {:g} s differ by {:.2g} m. "
                          "Motion with impacts or chaos spreads every error; a shorter --duration "
                          "or a larger error may do",
                          simulated, choice.error));
  choice.setting.setOptions(trial.period, scene.model.options);
  return fmt::format(
      "accuracy {:g} m: {}; estimated error {:.2g} m over {:g} s, {:.3g} s of CPU time per "
      "simulated second; {} trials took {:.2g} s{}",
      accuracy, choice.setting.text(trial.period), choice.error, simulated, choice.price,
      choice.trials, choice.trialSeconds,
      options.duration > simulated
          ? "; errors go on growing after that, --report-error estimates those of the whole run"
          : "");
}

}  // namespace softgauss::app

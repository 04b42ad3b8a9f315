// SPDX-License-Identifier: Apache-2.0
#include "apps/shared/run_choice.hpp"

#include <algorithm>

namespace softgauss::app {
namespace {

constexpr int kMostRounds = 10;  // of shorter trials

}  // namespace

RunChoice chooseForRun(double accuracy, double duration, const TrialSceneOf& sceneOf,
                       double wholeSeconds) {
  RunChoice run;
  run.tried = duration;
  TrialScene scene = sceneOf(duration);
  run.period = scene.period;
  scene.mostSeconds = wholeSeconds;
  run.choice = chooseSetting(accuracy, scene);
  if (!run.choice.late || duration <= kShortTrial) {
    if (run.choice.found) run.atEnd = run.choice.errors.back();
    return run;
  }

  run.whole = false;
  scene = sceneOf(kShortTrial);
  run.tried = scene.simulated;
  run.period = scene.period;
  scene.mostSeconds = kShortCpuSeconds;
  double spent = run.choice.trialSeconds, aim = accuracy * kShortTrial / duration;
  int trials = run.choice.trials;
  for (int round = 0; round < kMostRounds; ++round) {
    run.choice = chooseSetting(aim, scene);
    spent += run.choice.trialSeconds;
    trials += run.choice.trials;
    scene.mostSeconds -= run.choice.trialSeconds;
    if (!run.choice.found) break;
    run.growth = growthOf(run.choice.errors, run.tried);
    run.atEnd = run.growth.at(duration);
    run.choice.found = !run.growth.chaotic && run.atEnd <= accuracy;
    if (run.growth.chaotic || run.choice.found) break;
    aim *= 0.9 * accuracy / run.atEnd;
  }
  run.choice.trialSeconds = spent;
  run.choice.trials = trials;
  return run;
}

}  // namespace softgauss::app

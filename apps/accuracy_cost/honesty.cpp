// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/honesty.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "apps/shared/progress.hpp"

namespace softgauss::app {
namespace {

constexpr double kAccuracies[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

Method methodOf(const Setting& setting) {
  Method method{"softgauss",
                setting.midpointCoriolis ? std::string(integratorName(setting.integrator))
                                         : std::string(kMujocoEuler),
                setting.text(kPeriod)};
  method.tolerance = setting.tolerance;
  method.integrationTolerance = setting.integrationTolerance;
  method.doubling = setting.doubling;
  return method;
}

/// The fastest of ours that is as accurate; nothing where none is.
const Result* bestOf(const std::string& problem, double accuracy,
                     const std::vector<Result>& table) {
  const Result* best = nullptr;
  for (const Result& r : table)
    if (r.problem == problem && r.method.engine == "softgauss" &&
        r.method.cone == Cone::pyramidal && r.error <= accuracy && (!best || r.time < best->time))
      best = &r;
  return best;
}

HonestyCase examine(Study& study, const Problem& problem, const TrialScene& scene, double accuracy,
                    const std::vector<Result>& table) {
  HonestyCase c;
  c.problem = problem.name;
  c.accuracy = accuracy;
  const Result* best = bestOf(problem.name, accuracy, table);
  c.counted = best && tells(study.referenceError(), accuracy);
  if (!c.counted) return c;
  const Choice choice = chooseSetting(accuracy, scene);
  c.trialSeconds = choice.trialSeconds;
  c.found = choice.found;
  c.setting = choice.setting.text(kPeriod);
  std::vector<Result> both{study.measure(methodOf(choice.setting), kPeriod / choice.setting.steps),
                           study.measure(best->method, best->h)};
  study.measureTimes(both);
  c.error = both[0].error;
  c.time = both[0].time;
  c.best = fmt::format("{}, {:.4g} ms", best->method.label, 1e3 * best->h);
  c.bestTime = both[1].time;
  return c;
}

}  // namespace

void checkHonesty(const std::filesystem::path& folder, const std::vector<Problem>& problems,
                  const std::vector<Result>& table, const StudyOptions& options) {
  std::ofstream csv(folder / "honesty.csv");
  csv << "problem,accuracy_m,counted,found,setting,error_m,cpu_s_per_s,best,best_cpu_s_per_s,"
         "trial_s\n";
  int counted = 0, honest = 0, fast = 0;
  for (const Problem& problem : problems) {
    Study study(problem, options);
    const Method plain = methodOf({});
    if (!study.prepare(plain)) continue;
    const auto contestant = makeContestant(problem, plain, kPeriod);
    TrialScene scene;
    scene.model = &contestant->model();
    scene.period = kPeriod;
    scene.simulated = problem.windowPeriods * kPeriod * problem.windows;
    scene.longestStep = problem.contact ? kPeriod / kFewestContactSteps : kPeriod;
    scene.run = [&](const Setting& setting, double mostSeconds) {
      return study.tryOut(methodOf(setting), kPeriod / setting.steps, mostSeconds);
    };
    for (const double accuracy : kAccuracies) {
      if (interrupted()) return;
      const HonestyCase c = examine(study, problem, scene, accuracy, table);
      if (interrupted()) return;
      csv << fmt::format("{},{:g},{:d},{:d},\"{}\",{:.4g},{:.4g},\"{}\",{:.4g},{:.3g}\n", c.problem,
                         c.accuracy, c.counted, c.found, c.setting, c.error, c.time, c.best,
                         c.bestTime, c.trialSeconds)
          << std::flush;
      if (!c.counted) {
        fmt::print("{:<20} {:>6.0e} m  not counted\n", c.problem, c.accuracy);
        continue;
      }
      ++counted;
      honest += c.honest();
      fast += c.honest() && c.fast();
      fmt::print("{:<20} {:>6.0e} m  {}: true error {:.2g} m{}, {:.2f} of the best's time{} ({})\n",
                 c.problem, c.accuracy, c.found ? c.setting : "no setting found", c.error,
                 c.honest() ? "" : " TOO LARGE", c.time / c.bestTime, c.fast() ? "" : " TOO SLOW",
                 c.best);
    }
  }
  if (counted == 0) return;
  fmt::print(
      "{} cases: the true error is within what was asked in {:.1f} % of them, and the time within "
      "1.5 times the best's in {:.1f} %\n",
      counted, 100.0 * honest / counted, 100.0 * fast / counted);
}

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/verify_accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "apps/accuracy_cost/best.hpp"
#include "apps/accuracy_cost/user_path.hpp"
#include "apps/shared/progress.hpp"
#include "apps/shared/run_choice.hpp"

namespace softgauss::app {
namespace {

constexpr double kShare = 0.95;  // of the cases in which the promise has to be kept
constexpr double kAccuracies[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

Method methodOf(const Setting& setting) {
  Method method{"softgauss", std::string(integratorName(setting.integrator)),
                setting.text(kPeriod)};
  method.tolerance = setting.tolerance;
  method.integrationTolerance = setting.integrationTolerance;
  method.doubling = setting.doubling;
  return method;
}

/// The choice for a problem: as for a run where it is one motion, else over its windows.
RunChoice choose(const Study& study, const Problem& problem, const Model& model, double accuracy,
                 double wholeSeconds) {
  const auto sceneOf = [&](double simulated) {
    const int periods =
        std::min(problem.windowPeriods, static_cast<int>(std::lround(simulated / kPeriod)));
    TrialScene scene;
    scene.model = &model;
    scene.period = kPeriod;
    scene.simulated = periods * kPeriod * problem.windows;
    scene.longestStep = problem.contact ? kPeriod / kFewestContactSteps : kPeriod;
    scene.run = [&study, periods](const Setting& setting, double mostSeconds) {
      return study.tryOut(methodOf(setting), kPeriod / setting.steps, periods, mostSeconds);
    };
    return scene;
  };
  const double duration = problem.windowPeriods * kPeriod;
  if (problem.windows == 1) return chooseForRun(accuracy, duration, sceneOf, wholeSeconds);
  RunChoice run;
  run.choice = chooseSetting(accuracy, sceneOf(duration));
  return run;
}

AccuracyCase examine(Study& study, const Problem& problem, const Model& model, double accuracy,
                     const std::vector<Result>& table, double wholeSeconds,
                     const std::filesystem::path* asUsers) {
  AccuracyCase c;
  c.problem = problem.name;
  c.accuracy = accuracy;
  const Result* best = bestOf(table, problem.name, accuracy, "softgauss").result;
  c.counted = best && tells(study.referenceError(), accuracy);
  if (!c.counted) return c;
  Method method;
  double h = kPeriod;
  if (asUsers) {
    UserChoice user = chooseAsUser(problem, accuracy, *asUsers);
    c.found = user.found;
    c.setting = std::move(user.told);
    c.expected = std::numeric_limits<double>::quiet_NaN();  // it is in what was told
    method = std::move(user.method), h = user.h;
    if (!c.found) return c;
  } else {
    const RunChoice run = choose(study, problem, model, accuracy, wholeSeconds);
    const Choice& choice = run.choice;
    c.trialSeconds = choice.trialSeconds;
    c.found = choice.found;
    c.whole = run.whole;
    c.expected = run.whole ? choice.error : run.atEnd;
    c.setting = choice.setting.text(kPeriod);
    method = methodOf(choice.setting), h = kPeriod / choice.setting.steps;
  }
  std::vector<Result> both{study.measure(method, h), study.measure(best->method, best->h)};
  study.measureTimes(both);
  c.error = both[0].error;
  c.time = both[0].time;
  c.best = fmt::format("{}, {:.4g} ms", best->method.label, 1e3 * best->h);
  c.bestTime = both[1].time;
  return c;
}

void print(const AccuracyCase& c) {
  if (!c.counted) {
    fmt::print("{:<20} {:>6.0e} m  not counted\n", c.problem, c.accuracy);
    return;
  }
  fmt::print(
      "{:<20} {:>6.0e} m  {}: true error {:.2g} m{}{}; {:.2f} of the best's time{} "
      "({})\n",
      c.problem, c.accuracy, c.found ? c.setting : "no setting found", c.error,
      c.honest() ? "" : " TOO LARGE",
      std::isnan(c.expected)
          ? ""
          : fmt::format(", {:.2g} m {}", c.expected,
                        c.whole ? "expected" : "expected at the end by a shorter trial"),
      c.time / c.bestTime, c.fast() ? "" : " TOO SLOW", c.best);
}

}  // namespace

bool verifyAccuracy(const std::filesystem::path& folder, const std::vector<Problem>& problems,
                    const std::vector<Result>& table, const StudyOptions& options,
                    double wholeSeconds, bool asUsers) {
  std::ofstream csv(folder / "verify_accuracy.csv");
  csv << "problem,accuracy_m,counted,found,setting,error_m,cpu_s_per_s,best,best_cpu_s_per_s,"
         "trial_s,whole,expected_m\n";
  int counted = 0, honest = 0, fast = 0;
  for (const Problem& problem : problems) {
    Study study(problem, options);
    const Method plain = methodOf({});
    if (!study.prepare(plain)) continue;
    const auto tested = makeEngine(problem, plain, kPeriod);
    for (const double accuracy : kAccuracies) {
      if (interrupted()) return false;
      const AccuracyCase c = examine(study, problem, tested->model(), accuracy, table, wholeSeconds,
                                     asUsers ? &folder : nullptr);
      if (interrupted()) return false;
      csv << fmt::format(
                 "{},{:g},{:d},{:d},\"{}\",{:.4g},{:.4g},\"{}\",{:.4g},{:.3g},{:d},{:.4g}\n",
                 c.problem, c.accuracy, c.counted, c.found, c.setting, c.error, c.time, c.best,
                 c.bestTime, c.trialSeconds, c.whole, c.expected)
          << std::flush;
      print(c);
      counted += c.counted;
      honest += c.counted && c.honest();
      fast += c.counted && c.honest() && c.fast();
    }
  }
  if (counted == 0) return true;
  fmt::print(
      "{} cases: the true error is within what was asked in {:.1f} % of them, and the time within "
      "1.5 times the best's in {:.1f} %\n",
      counted, 100.0 * honest / counted, 100.0 * fast / counted);
  return honest >= kShare * counted && fast >= kShare * counted;
}

}  // namespace softgauss::app

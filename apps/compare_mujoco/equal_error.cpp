// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/equal_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "apps/accuracy_cost/study.hpp"

namespace softgauss::app {
namespace {

constexpr double kStep = 0.002;  ///< both defaults [s]

Problem swing(int links, int periods) {
  Problem problem;
  problem.name = "chain";
  problem.build = [links] { return chain(links); };
  problem.periods = problem.windowPeriods = periods;
  return problem;
}

/// A way to an error, and what it takes.
struct Way {
  std::string integrator;
  double h = 0.0, time = kInfinity;  ///< [s], CPU seconds per simulated second
};

/// What a method takes for an error, by its results from the longest step to the shortest.
std::optional<Way> wayTo(double error, const std::vector<Result>& results) {
  const Result* before = nullptr;
  for (const Result& r : results) {
    if (!std::isfinite(r.error)) {
      before = nullptr;
      continue;
    }
    if (r.error <= error) {
      Way way{r.method.integrator, r.h, r.time};
      if (before) {
        const double part = std::log(error / r.error) / std::log(before->error / r.error);
        way.h = r.h * std::pow(before->h / r.h, part);
        way.time = r.time * std::pow(before->time / r.time, part);
      }
      return way;
    }
    before = &r;
  }
  return std::nullopt;
}

/// From the longest step on, until one is ten times as good as asked for.
std::vector<Result> measureDownTo(double error, const Method& method, Study& study) {
  std::vector<Result> results;
  for (int steps = kFewestSteps; steps <= kMostSteps; steps *= 2) {
    results.push_back(study.measure(method, kPeriod / steps));
    if (results.back().error <= 0.1 * error) break;
  }
  return results;
}

}  // namespace

EqualError swingAtEqualError(int links, int periods, int repeats) {
  const Problem problem = swing(links, periods);
  StudyOptions options;
  options.repeats = repeats;
  Study study(problem, options);
  const Method ours{"softgauss", "leapfrog", "leapfrog"};
  EqualError result;
  if (!study.prepare(ours)) {
    result.refused = "the reference is not finite";
    return result;
  }
  std::vector<Result> own{study.measure(ours, kStep)};
  result.error = own.front().error;
  if (!tells(own.front().referenceError, result.error)) {
    result.refused = fmt::format("references differ by {:.1g} m, our error is {:.1g} m",
                                 own.front().referenceError, result.error);
    return result;
  }
  std::vector<std::vector<Result>> all;
  for (const Method& method : mujocoMethods(problem)) {
    all.push_back(measureDownTo(result.error, method, study));
    if (method.integrator == "Euler") result.theirs = study.measure(method, kStep).error;
  }
  study.measureTimes(own);
  Way cheapest;
  for (std::vector<Result>& results : all) {
    study.measureTimes(results);
    if (const auto way = wayTo(result.error, results); way && way->time < cheapest.time)
      cheapest = *way;
  }
  if (cheapest.integrator.empty()) {
    result.refused = fmt::format("no step of MuJoCo's reaches our error, {:.1g} m", result.error);
    return result;
  }
  result.times = {1e6 * kStep * own.front().time, 1e6 * kStep * cheapest.time};
  result.way = fmt::format("{} at {:.2g} ms", cheapest.integrator, 1e3 * cheapest.h);
  return result;
}

}  // namespace softgauss::app

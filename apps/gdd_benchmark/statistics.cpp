// SPDX-License-Identifier: Apache-2.0
#include "apps/gdd_benchmark/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "softgauss/io/nearest_rank.hpp"

namespace softgauss::app {

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(io::nearestRank(share, values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

Spread Spread::of(const std::vector<double>& values) {
  if (values.empty()) return {};
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {sum / static_cast<double>(values.size()), percentile(values, 0.5),
          percentile(values, 0.95), *std::max_element(values.begin(), values.end())};
}

SolverStatistics::SolverStatistics(const Replay& replay, const Replay::Solver& solver) {
  std::vector<double> iterationsOf, dualsOf, violationOf, gradientOf, smoothIterationsOf,
      smoothViolationOf, forwardOf, solveOf, finishOf, stepOf, solveStepOf;
  for (std::size_t i = 0; i < solver.records.size(); ++i) {
    const Solved& r = solver.records[i];
    iterationsOf.push_back(r.report.iterations);
    dualsOf.push_back(r.report.dualUpdates);
    violationOf.push_back(r.report.violation);
    const bool smooth = r.report.status == gdd::GddStatus::converged;
    const bool kink = r.report.status == gdd::GddStatus::nonsmoothMinimum;
    if (smooth) {
      gradientOf.push_back(r.report.stationarity);
      smoothIterationsOf.push_back(r.report.iterations);
      smoothViolationOf.push_back(r.report.violation);
    }
    kinks += kink;
    certified += smooth || kink;
    atLimit += r.report.status == gdd::GddStatus::iterationLimit;
    unlikeRecorded += !r.controlAsRecorded;
    forwardOf.push_back(r.forwardIterations);
    solveOf.push_back(r.solveUs);
    finishOf.push_back(r.finishUs);
    solveStepOf.push_back(replay.stagesUs[i] + r.solveUs);
    stepOf.push_back(solveStepOf.back() + r.finishUs);
  }
  const double count = std::max<double>(1.0, static_cast<double>(solver.records.size()));
  kinks /= count;
  certified /= count;
  iterations = Spread::of(iterationsOf);
  dualUpdates = Spread::of(dualsOf);
  violation = Spread::of(violationOf);
  smoothGradient = Spread::of(gradientOf);
  smoothIterations = Spread::of(smoothIterationsOf);
  smoothViolation = Spread::of(smoothViolationOf);
  forwardIterations = Spread::of(forwardOf);
  solveUs = Spread::of(solveOf);
  finishUs = Spread::of(finishOf);
  solveStepUs = Spread::of(solveStepOf);
  stepUs = Spread::of(stepOf);
}

Comparison::Comparison(const std::vector<Solved>& first, const std::vector<Solved>& second) {
  std::vector<double> firstBy, secondBy;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double a = first[i].objective, b = second[i].objective;
    const double size = std::max(std::abs(a), std::abs(b));
    const double gap = size > 0.0 ? (b - a) / size : 0.0;
    if (std::abs(gap) <= kEqual)
      ++equal;
    else
      (gap > 0.0 ? firstBy : secondBy).push_back(std::abs(gap));
  }
  firstBetter = static_cast<int>(firstBy.size());
  secondBetter = static_cast<int>(secondBy.size());
  firstBetterBy = Spread::of(firstBy);
  secondBetterBy = Spread::of(secondBy);
}

}  // namespace softgauss::app

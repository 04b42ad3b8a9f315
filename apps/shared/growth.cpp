// SPDX-License-Identifier: Apache-2.0
#include "apps/shared/growth.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::app {
namespace {

constexpr std::size_t kWindows = 8;
constexpr int kRefinements = 4;
/// A window in which nothing is off tells nothing of how errors grow [m].
constexpr double kRounding = 1e-15;
/// Errors that are added up from step to step grow as fast as time at least, in the long run.
constexpr double kLeastPower = 1.0;

struct Line {
  double slope = 0.0, height = 0.0;
  double residual = 0.0;  ///< mean square
};

/// Samples [from, to) at equal intervals, the first of all at the end of the first.
struct Window {
  std::size_t from, to;
  double interval;  ///< [s]

  double time(std::size_t k) const { return interval * static_cast<double>(k + 1); }
  /// log of the time t at which t^p is the root mean square of that of the samples.
  double logTime(double power) const {
    double sum = 0.0;
    for (std::size_t k = from; k < to; ++k) sum += std::pow(time(k), 2.0 * power);
    return std::log(sum / static_cast<double>(to - from)) / (2.0 * power);
  }
};

Line fit(const std::vector<double>& x, const std::vector<double>& y) {
  const double n = static_cast<double>(x.size());
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i], sy += y[i];
    sxx += x[i] * x[i], sxy += x[i] * y[i];
  }
  Line line;
  line.slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  line.height = (sy - line.slope * sx) / n;
  for (std::size_t i = 0; i < x.size(); ++i)
    line.residual += std::pow(y[i] - line.height - line.slope * x[i], 2) / n;
  return line;
}

}  // namespace

double Growth::at(double time) const { return std::max(largest, scale * std::pow(time, power)); }

Growth growthOf(const std::vector<double>& errors, double duration) {
  Growth growth;
  const std::size_t count = std::min(kWindows, errors.size());
  std::vector<Window> windows;
  std::vector<double> middles, logErrors;
  for (std::size_t w = 0; w < count; ++w) {
    const Window window{w * errors.size() / count, (w + 1) * errors.size() / count,
                        duration / static_cast<double>(errors.size())};
    double sum = 0.0;
    for (std::size_t k = window.from; k < window.to; ++k) {
      growth.largest = std::max(growth.largest, errors[k]);
      sum += errors[k] * errors[k];
    }
    const double error = std::sqrt(sum / static_cast<double>(window.to - window.from));
    if (error < kRounding) continue;
    windows.push_back(window);
    middles.push_back(0.5 * (window.time(window.from) + window.time(window.to - 1)));
    logErrors.push_back(std::log(error));
  }
  growth.scale = growth.largest / duration;
  if (windows.size() < 3) return growth;

  // The time that stands for a window depends on the power.
  std::vector<double> logTimes(windows.size());
  Line power;
  power.slope = kLeastPower;
  for (int i = 0; i < kRefinements; ++i) {
    for (std::size_t w = 0; w < windows.size(); ++w)
      logTimes[w] = windows[w].logTime(std::max(power.slope, kLeastPower));
    power = fit(logTimes, logErrors);
  }
  const Line exponential = fit(middles, logErrors);
  growth.power = std::max(power.slope, kLeastPower);
  // Through the middle of what was seen, or through the last window where that is higher.
  double height = 0.0;
  for (std::size_t w = 0; w < windows.size(); ++w)
    height += (logErrors[w] - growth.power * logTimes[w]) / static_cast<double>(windows.size());
  height = std::max(height, logErrors.back() - growth.power * logTimes.back());
  growth.scale = std::exp(height);
  growth.rate = exponential.slope;
  growth.chaotic = exponential.residual < 0.25 * power.residual &&
                   exponential.slope * (middles.back() - middles.front()) > std::log(10.0);
  return growth;
}

}  // namespace softgauss::app

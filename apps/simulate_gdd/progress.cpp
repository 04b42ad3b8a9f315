// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "apps/shared/progress.hpp"
#include "apps/shared/standard_streams.hpp"

namespace softgauss::app {

RunProgress::RunProgress(double duration, bool quiet)
    : duration_(duration), visible_(!quiet && isatty(fileno(stderr))) {}

void RunProgress::show(double simulated, double elapsed) {
  if (!visible_ || elapsed - lastShown_ < 0.1) return;
  lastShown_ = elapsed;
  const std::string bar = progressBar(std::clamp(simulated / duration_, 0.0, 1.0));
  const double speed = elapsed > 0.0 ? simulated / elapsed : 0.0;
  const double left = speed > 0.0 ? (duration_ - simulated) / speed : 0.0;
  print(stderr, fmt::format("\r{} {:6.2f} / {:.4g} s   {:5.1f} × real time   {:.0f} s left \033[K",
                            bar, simulated, duration_, speed, left));
  std::fflush(stderr);
}

void RunProgress::showTrial(int trial, const std::string& setting, double share, double elapsed) {
  if (!visible_ || elapsed - lastShown_ < 0.1) return;
  lastShown_ = elapsed;
  print(stderr, fmt::format("\rtrial {}: {}: {:.0f} %   {:.0f} s \033[K", trial, setting,
                            100.0 * share, elapsed));
  std::fflush(stderr);
}

void RunProgress::showPlan(bool feasible, int iterations, double cost, double rootForce,
                           double elapsed) {
  if (!visible_ || elapsed - lastShown_ < 0.1) return;
  lastShown_ = elapsed;
  print(stderr, fmt::format("\rplanning: {} iterations, phase {}: cost {:.6g}, root force {:.3g}   "
                            "{:.0f} s \033[K",
                            iterations, feasible ? "F" : "I", cost, rootForce, elapsed));
  std::fflush(stderr);
}

void RunProgress::clear() {
  if (!visible_ || lastShown_ < 0.0) return;
  print(stderr, "\r\033[K");
  std::fflush(stderr);
}

}  // namespace softgauss::app

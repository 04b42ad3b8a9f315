// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A progress bar on a terminal; nothing elsewhere.

#include <string>

namespace softgauss::app {

class RunProgress {
 public:
  RunProgress(double duration, bool quiet);
  /// Simulated time, speed against real time and remaining time; redraws ten times a second.
  void show(double simulated, double elapsed);
  /// Of a trial before the run: which one it is, what it tries, and how far it is.
  void showTrial(int trial, const std::string& setting, double share, double elapsed);
  /// Of planning: the phase, the iterations so far, the cost and the root force left.
  void showPlan(bool feasible, int iterations, double cost, double rootForce, double elapsed);
  void clear();

 private:
  double duration_;
  bool visible_;
  double lastShown_ = -1.0;
};

}  // namespace softgauss::app

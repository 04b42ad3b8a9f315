// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A setting for an accuracy over a whole run.
///
/// The trial is of the whole run where that takes no more CPU time than it may. Else it is of the
/// first two seconds: then the setting is chosen so that its error, as it grows there (growth.hpp),
/// is within the accuracy at the end of the run. Of what begins to move or to touch later such a
/// trial knows nothing: that is a forecast, and no promise.

#include "apps/shared/growth.hpp"
#include "apps/shared/setting.hpp"

namespace softgauss::app {

inline constexpr double kShortTrial = 2.0;         // [s]
inline constexpr double kTrialCpuSeconds = 60.0;   // of a trial of the whole run, at most
inline constexpr double kShortCpuSeconds = 120.0;  // of all shorter ones

struct RunChoice {
  Choice choice;        ///< of the trial that counts; its price and time are of all trials
  double tried = 0.0;   ///< duration of that trial [s]
  double period = 0.0;  ///< of that trial [s]
  bool whole = true;    ///< it is that of the run
  double atEnd = 0.0;   ///< estimated error at the end of the run [m]
  Growth growth;        ///< of the error in the trial, where it is not whole
};

/// The scene of a trial that takes `simulated` seconds from the start of the run.
using TrialSceneOf = std::function<TrialScene(double simulated)>;

/// `wholeSeconds`: CPU time that a trial of the whole run may take [s].
RunChoice chooseForRun(double accuracy, double duration, const TrialSceneOf& sceneOf,
                       double wholeSeconds = kTrialCpuSeconds);

}  // namespace softgauss::app

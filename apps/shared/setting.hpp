// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A setting for an accuracy: integrator, step and solver tolerance, chosen by a measured trial.
///
///   e(n) ≈ e(m) (m/n)^p       n, m: steps a period, p: the integrator's order
///
/// Every trial runs the scene, from the same start and for the same time, with one setting, and is
/// compared with a reference of the same scene. The reference is an accurate run that a second
/// one, at another setting, agrees with to a fifth of the accuracy asked for; where no two runs
/// agree so well the motion is chaotic, or the forces too rough, and no setting can promise it.

#include <functional>
#include <string>
#include <vector>

#include "softgauss/engine/engine.hpp"

namespace softgauss::app {

struct Setting {
  Integrator integrator = Integrator::leapfrog;
  int steps = 16;                     ///< a period of the trial
  bool doubling = false;              ///< Options::stepDoubling
  double integrationTolerance = 0.0;  ///< of error control; 0: none
  double tolerance = 1e-12;           ///< of the solver

  void setOptions(double period, Options& options) const;
  /// "dormand-prince to 1e-06, 16 ms, solver to 1e-12"
  std::string text(double period) const;
};

/// Of the accuracy, by which two references may differ.
inline constexpr double kReferenceShare = 0.2;

/// What a run with a setting came to.
struct TrialRun {
  bool finite = false;
  bool late = false;           ///< not finite for that it takes too long
  double lostAt = kInfinity;   ///< simulated time at which a step was refused [s]; ∞: none was
  double seconds = 0.0;        ///< CPU time, of the steps alone
  bool touches = true;         ///< rows of contacts or joint limits may have acted
  std::vector<State> samples;  ///< at the ends of periods, the same in every trial
};

/// The scene in which a setting is tried.
struct TrialScene {
  const Model* model = nullptr;  ///< for link poses
  double period = 0.032;         ///< samples are taken this often [s]
  double simulated = 0.0;        ///< duration of a trial [s]
  /// [s]; beyond it the step would change the model, where something touches.
  double longestStep = 0.032;
  double mostSeconds = kInfinity;  ///< CPU time of all trials; the best so far counts at its end
  /// Not finite and late where it takes more than so many CPU seconds.
  std::function<TrialRun(const Setting&, double mostSeconds)> run;
};

struct Choice {
  Setting setting;
  bool found = false;      ///< a setting that is estimated to be as accurate as asked for
  bool referenced = true;  ///< false: no two accurate runs agree
  bool late = false;       ///< of two accurate runs none came to its end in time
  /// Without two accurate runs that come to their end: the earliest time at which one of them, none
  /// of which was late, had a step refused [s].
  double lostAt = kInfinity;
  /// Estimated, root mean square over links and samples [m]; without a reference the least by which
  /// two accurate runs differ, ∞ where no two came to their end.
  double error = kInfinity;
  std::vector<double> errors;  ///< the same of each sample
  double price = 0.0;          ///< CPU seconds per simulated second
  double trialSeconds = 0.0;
  int trials = 0;
};

/// The cheapest setting with an error of at most `accuracy` [m].
Choice chooseSetting(double accuracy, const TrialScene& scene);

/// The longest step that does not change the soft constraints of a model: half of the shortest
/// time constant of contacts and joint limits, ∞ where it has neither [s].
double longestStepFor(const Model& model);

}  // namespace softgauss::app

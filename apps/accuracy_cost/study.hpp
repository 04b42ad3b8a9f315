// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Error and time of every method and step size on a problem.
///
/// A problem is cut into windows, each from a state of the reference; every engine starts each
/// window there, and is compared with the reference at the end of every period. A smooth problem
/// has one window, the whole motion. The reference is the closed form where there is one, else the
/// most accurate method; a second, coarser one tells how good it is. With other cones, or in
/// another engine, contact is another model: such a method is compared with its own reference,
/// which says how far it is from its own limit. With contact the error of one step is measured too,
/// from the start of every window.

#include "apps/accuracy_cost/engine_under_test.hpp"
#include "apps/shared/pose_error.hpp"
#include "apps/shared/setting.hpp"

namespace softgauss::app {

/// One marker of a picture.
struct Result {
  std::string problem;
  Method method;
  double h = 0.0;  ///< [s]
  /// Root mean square over windows and periods [m]; ∞: not finite; NaN: it took too long.
  double error = 0.0;
  double orientation = 0.0;  ///< the same of angles [rad]
  double time = 0.0;         ///< CPU seconds per simulated second; given up: what it had of them
  /// Drift is against the reference, at the ends of periods, where that is known: dampers and
  /// contacts may take energy. Largest gain or loss over the largest kinetic energy, if passive.
  double energyDrift = 0.0;
  /// Largest difference of linear or angular momentum to the reference, over the largest there.
  double momentumDrift = 0.0;
  double penetration = 0.0;     ///< deepest after any step [m]
  double overshoot = 0.0;       ///< beyond a joint's limit, largest after any step [rad or m]
  double referenceError = 0.0;  ///< by which two references differ [m]
  double oneStep = 0.0;         ///< with contact: error after one step, over the windows [m]
};

/// References tell an error where they agree ten times better.
inline constexpr double kReferenceTells = 0.1;
inline bool tells(double referenceError, double error) {
  return referenceError <= kReferenceTells * error;
}

struct StudyOptions {
  double minTime = 0.05;  ///< CPU seconds at least that a time is measured over
  int repeats = 3;        ///< of which the least is taken; 0: the run that gave the error counts
  double longRun = 5.0;   ///< CPU seconds of all windows, beyond which a time is measured once
  double mostSeconds = 60.0;  ///< CPU seconds of all windows, beyond which a setting is given up
};

/// Of all windows [s].
double simulatedOf(const Problem& problem);
/// StudyOptions::mostSeconds as CPU seconds per simulated second.
double mostTime(const Problem& problem, const StudyOptions& options);

class Study {
 public:
  Study(const Problem& problem, StudyOptions options);

  /// The references of a method's model, worked out once; false where even they are not finite.
  bool prepare(const Method& method);
  /// Measures a method at a step size, after prepare(). Times are measured by measureTimes().
  Result measure(const Method& method, double h);
  /// Fills in the times of results of one step size, run in turns.
  void measureTimes(std::vector<Result>& results);
  /// All windows once, of so many periods, after prepare(), as a trial of shared/setting.hpp.
  TrialRun tryOut(const Method& method, double h, int periods, double mostSeconds) const;
  double referenceError() const { return references_[current_].error; }

 private:
  struct Window {
    State start;
    std::vector<State> samples;  ///< at the end of each period
    std::vector<State> first;  ///< with contact: after the shortest step, twice, four times … it
  };
  struct Reference {
    References of;
    std::vector<Window> windows;  ///< empty: it is not finite
    double error = 0.0;           ///< by which two references differ [m]
  };
  const std::vector<Window>& windows() const { return references_[current_].windows; }
  Reference makeReference(const References& of) const;
  /// CPU time that steps may take, and took [s].
  struct Budget {
    double most = kInfinity, spent = 0.0;
    bool exceeded() const { return spent > most; }
  };
  /// What is looked at after every step.
  struct Watch {
    double overlap = 0.0;    ///< deepest of a contact [m]
    double overshoot = 0.0;  ///< beyond a joint's limit, largest [rad or m]
  };
  std::vector<State> run(EngineUnderTest& tested, const State& start, int periods, int steps,
                         Budget& budget, Watch* watch = nullptr) const;
  std::vector<State> firstSteps(const References& of, const State& start) const;
  double oneStep(EngineUnderTest& tested, double h) const;
  State initialState(const Model& model) const;
  VectorX force(const Model& model, double time) const;

  Problem problem_;
  StudyOptions options_;
  std::vector<Reference> references_;
  std::size_t current_ = 0;  ///< of the method that was prepared last
};

}  // namespace softgauss::app

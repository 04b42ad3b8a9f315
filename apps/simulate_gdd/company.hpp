// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The steps of a run counted, and who acts between them, if anybody does.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/live/hands.hpp"
#include "apps/simulate_gdd/companion.hpp"
#include "apps/simulate_gdd/scene.hpp"

namespace softgauss::app {

class Company {
 public:
  /// The parts of the run outlive it. Where somebody is to act, the controller gets goals for that.
  Company(const SimulateOptions& options, Scene& scene, State& state, std::optional<Data>& data,
          gdd::GoalDirectedController& controller);

  /// Lets them begin. The stages of the initial state are in `start`. Throws UsageError,
  /// ModelError.
  void join(const Scene& scene, const gdd::GoalContext& start);
  /// What is to be told before the first step, even where little is told.
  std::string announcement() const;

  /// Whether one more step is to be taken: waits and does what is asked for; `back` is called with
  /// the time to which the run has gone back [s].
  enum class Next { step, end, interrupted };
  template <class Back>
  Next next(Back&& back) {
    for (const auto& companion : companions_) {
      if (!companion->before(taken_)) return companion->reloads() ? Next::end : Next::interrupted;
      if (!hands_ || !hands_->jumped()) continue;
      back(state_.time);
      for (const auto& other : companions_) other->moved();
    }
    return taken_ < steps_ ? Next::step : Next::end;
  }
  /// The wrenches of the step, in place of those of the last.
  void beginWrenches(Input& input) const {
    if (hands_) input.wrenches.clear();
  }
  void addWrenches(const Kinematics& kinematics, Input& input) const {
    if (hands_) hands_->addWrench(kinematics, input.wrenches);
  }
  void after(const SeenStep& step, const Verdict& verdict) {
    for (const auto& companion : companions_) companion->after(step, verdict);
  }
  void tell(const std::string& message) {
    for (const auto& companion : companions_) companion->tell(message);
  }
  /// A step is complete: the state's time is that of whole steps.
  void countStep();
  /// Throws std::runtime_error where a file could not be written.
  void finish() {
    for (const auto& companion : companions_) companion->finish(taken_);
  }
  void conclude(io::Summary& summary) {
    for (const auto& companion : companions_) companion->conclude(summary);
  }
  bool acts() const { return options_.acted(); }  ///< on the run, but for the control
  /// Of a run on which nobody acts.
  template <class Archive>
  void archive(Archive& a) {
    a(taken_, instant_);
  }

 private:
  const SimulateOptions& options_;
  const Model& model_;
  State& state_;
  const gdd::GoalDirectedController& controller_;
  long steps_ = 0;    ///< of the run
  long taken_ = 0;    ///< of those
  long instant_ = 0;  ///< from the start to the state
  std::optional<live::Hands> hands_;
  std::vector<std::unique_ptr<Companion>> companions_;  ///< who acts, then who follows
};

}  // namespace softgauss::app

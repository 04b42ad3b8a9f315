// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a run came to, for a person: did the robot stand or fall, which goals were reached, which
/// were not and why, what was saturated, slid, chattered or was not certified.

#include <string>
#include <utility>
#include <vector>

#include "apps/simulate_gdd/goal_record.hpp"
#include "apps/simulate_gdd/held_back.hpp"
#include "apps/simulate_gdd/joint_watch.hpp"
#include "apps/simulate_gdd/oddities.hpp"
#include "apps/simulate_gdd/standing.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"
#include "softgauss/io/simulation/base_notes.hpp"

namespace softgauss::app {

/// A step that was taken, or the state at the end.
struct SeenStep {
  const io::StepRecord& record;  ///< of its start, control and energies included
  const Data& data;              ///< kinematics of the start, accelerations of the step
  const std::vector<Snapshot::ContactForce>& contacts;  ///< with the forces of the step
  const State& after;
  double length;          ///< [s]
  const Input& input;     ///< what acted besides the control
  ContactSource& source;  ///< of contacts
};

class Verdict {
 public:
  /// `start`: the initial state, whose stages are computed. `passive`: nothing drives the scene.
  Verdict(gdd::GoalDirectedController& controller, const gdd::GoalContext& start, bool passive,
          const BaseNotes& bases);

  /// Returns what is to be told at once.
  std::vector<std::string> observe(const SeenStep& step);
  /// What was seen, for a run that goes on later.
  template <class Archive>
  void archive(Archive& a) {
    a(goals_, joints_, standing_, oddities_);
  }
  /// The state at the end, with the contacts of the last step.
  void finish(const SeenStep& end);

  /// Errors of the goals at the last step seen, and their names with units.
  const GoalRecord& goals() const { return goals_; }
  /// Whether some robot lies where it stood; after finish().
  bool fell() const;
  /// Root links of robots that lie where they stood, at these kinematics.
  std::vector<std::string> lying(const Kinematics& kinematics, double time) const;
  /// Controls that are at their bounds, joints that are at an end of their range.
  std::vector<std::string> saturatedNow() const;
  std::vector<std::string> atLimitsNow() const;
  /// After finish(): goals and verdict. `ending` says why a run ended early, or is empty.
  void tell(const std::string& ending, const std::vector<std::string>& baseWarnings,
            io::Summary& summary);

 private:
  void findReason(GoalRecord::Track& track, const SeenStep& step);
  std::vector<char> dofsOf(const GoalRecord::Track& track) const;
  std::string reachReason(GoalRecord::Track& track, const SeenStep& step) const;
  std::string heldText(GoalRecord::Track& track, const SeenStep& step);
  std::string actuationReason(const GoalRecord::Track& track) const;
  void tellStanding(io::Summary& summary) const;
  void tellGoals(io::Summary& summary) const;
  void tellControls(io::Summary& summary) const;

  const Model& model_;
  gdd::GoalDirectedController& controller_;
  BaseOrigin baseOrigin_;
  std::string straightKnees_;
  std::vector<char> bolted_;  ///< (trees) looks as if it were to be bolted down
  HeldBack heldBack_;
  GoalRecord goals_;
  JointWatch joints_;
  Standing standing_;
  Oddities oddities_;
  State at_;                            ///< q, v and time of the step seen
  std::vector<StandingOutcome> stood_;  ///< at the end
};

}  // namespace softgauss::app

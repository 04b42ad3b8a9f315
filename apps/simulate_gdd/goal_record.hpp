// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far the robot is from its goals over a run, each judged at its own end.

#include <memory>
#include <string>
#include <vector>

#include "softgauss/gdd/goal.hpp"
#include "softgauss/io/summary.hpp"

namespace softgauss::app {

/// Figures of goals, by the figure. What only regularises has none.
class GoalRecord {
 public:
  /// One figure of a goal, and what has become of it.
  struct Track {
    const gdd::Goal* goal;
    io::GoalOutcome outcome;
    gdd::GoalError last;   ///< while the goal acted
    bool acts = false;     ///< in the last step seen
    double weighed = 0.0;  ///< share of what holds it back that is other weights, at the end

    template <class Archive>
    void archive(Archive& a) {
      a(outcome, last.value, last.met, last.dof, acts);
    }
    /// It begins only if somebody asks, and nobody did.
    bool wasNotAsked() const;
  };

  /// The goals have to live as long. `start`: the initial state, whose stages are computed.
  GoalRecord(const std::vector<std::unique_ptr<gdd::Goal>>& goals, const gdd::GoalContext& start);

  /// A step's start, with the contact forces of the step. Returns the tracks whose goal has ended
  /// since the last one, with their outcome complete but for the reason.
  std::vector<Track*> observe(const gdd::GoalContext& context, const gdd::ContactForces& contacts);

  template <class Archive>
  void archive(Archive& a) {
    a.sized(tracks_);
    if constexpr (Archive::kReads)
      for (const Track& track : tracks_) a.expect(track.last.dof >= -1 && track.last.dof < dofs_);
  }
  std::vector<Track>& tracks() { return tracks_; }
  const std::vector<Track>& tracks() const { return tracks_; }
  /// As columns are called: "reach hand [m]".
  std::vector<std::string> columns() const;
  /// The present errors, one a track; NaN where a goal has none.
  const VectorX& errors() const { return errors_; }

 private:
  void see(Track& track, const gdd::GoalError& figure, double time, bool acts);

  int dofs_;
  std::vector<Track> tracks_;
  std::vector<gdd::GoalError> figures_;  ///< scratch
  VectorX errors_;
};

}  // namespace softgauss::app

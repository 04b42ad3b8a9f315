// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A run as it is looked at: what the replay page and the plots are made of.
///
/// The recorder turns steps into frames (poses, contacts, goals) and series (curves over time). It
/// reads the engine's Snapshot and the goals' marks; engine and gdd know nothing of it.

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "softgauss/engine/model/state.hpp"
#include "softgauss/engine/step/saved_contacts.hpp"
#include "softgauss/io/log.hpp"
#include "softgauss/io/mesh_images.hpp"
#include "softgauss/io/replay/frames.hpp"
#include "softgauss/io/replay/series.hpp"

namespace softgauss::io {

/// One quantity over time: a column of the series, and its limits where it has some.
struct Curve {
  std::string name;
  int column = 0;
  double lower = -kInfinity;
  double upper = kInfinity;
};

/// Whether a limit is near what a curve comes to: within its span, or within 2 % of the range
/// between the limits. A curve is drawn at its own scale, and only limits that are near are marked:
/// a motor of 87 N m that gives 3 would else be a flat line.
struct NearLimits {
  bool lower = false;
  bool upper = false;
  /// `least`, `greatest`: of the curve.
  NearLimits(const Curve& curve, double least, double greatest);
};

/// Curves of one unit that belong together, a plot.
struct CurveGroup {
  std::string name;
  std::string unit;
  bool logarithmic = false;
  std::vector<Curve> curves;
};

/// How the run ended.
struct Outcome {
  std::string kind = "completed";  ///< or "fell", "non-finite", "interrupted"
  std::string message;             ///< the reason, when it did not complete
};

class Recording {
 public:
  /// A goal as it was when the recording began.
  struct GoalLabel {
    std::string name;  ///< e.g. "reach right_hand"
    std::string link;
  };

  /// The model must outlive the recording. `goals`: those of the controller; may be empty.
  Recording(const Model& model, const std::vector<std::unique_ptr<gdd::Goal>>& goals,
            const gdd::GoalContext& start);

  /// A plot of what only the caller knows, whose values of a step `added` holds as it is added, in
  /// the order of all such curves; NaN is a gap. To be called before the first step.
  void addPlot(std::string name, std::string unit, const std::vector<std::string>& curves);
  std::vector<double> added;
  /// What is to come, so that memory is fetched before the run.
  void reserve(std::size_t steps, double duration) {
    series_.reserve(steps);
    frames_.reserve(duration);
  }
  /// A step that was taken: its record, and the stages that it was taken from.
  void addStep(const StepRecord& record, const Data& data);
  /// The same with the contact forces from elsewhere.
  void addStep(const StepRecord& record, const Data& data,
               const std::vector<Snapshot::ContactForce>& contacts);
  /// The run goes on from `time` [s], which lies back: what comes later is forgotten.
  void rewind(double time) {
    frames_.rewind(time);
    series_.rewind(time);
  }
  /// The state that the run ended with, whose stages are in `data`. The frame shows the contact
  /// forces of the last step, which led there; curves of what a solve gives end before it.
  void finish(const StepRecord& last, const Data& data);

  /// The goals are there no more, and have no marks from here on.
  void forgetGoals() { std::fill(goals_.begin(), goals_.end(), nullptr); }
  void forgetGoal(const gdd::Goal& goal) {
    std::replace(goals_.begin(), goals_.end(), &goal, static_cast<const gdd::Goal*>(nullptr));
  }

  /// What was recorded, for a run that goes on later.
  template <class Archive>
  void archive(Archive& a) {
    a(series_, frames_, contacts_);
    if constexpr (Archive::kReads) a.expect(fits(model_, contacts_));
  }

  const Model& model() const { return model_; }
  const FrameTrack& frames() const { return frames_; }
  const SeriesTable& series() const { return series_; }
  const std::vector<GoalLabel>& goalLabels() const { return labels_; }
  /// The goals of those labels.
  const std::vector<const gdd::Goal*>& places() const { return goals_; }
  /// Of one of them; nothing while it does not act.
  std::optional<gdd::GoalMark> markOf(std::size_t place, const gdd::GoalContext& context) const {
    const gdd::Goal* goal = goals_[place];
    return goal && goal->actsAt(context.state.time) ? goal->mark(context) : std::nullopt;
  }
  /// The plots, without those that are zero throughout, and without curves that are, such as the
  /// force on a link that nothing touched; joints at rest beside others that move are kept.
  std::vector<CurveGroup> plots() const;

  // What only the caller knows.
  std::string command;  ///< how the run was started
  Outcome outcome;
  std::vector<std::pair<std::string, std::string>> facts;  ///< shown as they are
  std::vector<std::string> warnings;
  /// What collides in place of a mesh, by geometry; null where the shape itself does.
  std::vector<std::shared_ptr<const Mesh>> hulls;
  std::map<const Mesh*, MeshImages> images;  ///< that cover visual meshes, of those that have any

 private:
  CurveGroup& addGroup(std::string name, std::string unit, bool logarithmic = false);
  void addCurve(CurveGroup& group, std::string name, double lower = -kInfinity,
                double upper = kInfinity);
  void addJointGroups();
  void addOtherGroups();
  void makeSeries();
  void readMarks(const StepRecord& record, const Data& data);
  void writeSample(const StepRecord& record, bool isEnd, double* sample);

  const Model& model_;
  std::vector<const gdd::Goal*> goals_;  ///< those that are a place
  std::vector<GoalLabel> labels_;
  std::vector<CurveGroup> groups_;
  std::size_t jointGroups_ = 0;  ///< how many of them, the first, are of joints
  int columns_ = 0;
  // What a sample is read from, in the order of the columns.
  std::vector<int> q_, u_, v_, base_;  ///< entries of q, of u, of v, of q again
  std::vector<int> forceColumn_;       ///< (geometries) of the force on its body, −1: none
  int forceColumns_ = 0;               ///< how many, that of all contacts included

  SeriesTable series_;
  FrameTrack frames_;
  State state_;  ///< of the step that is added, without its warm start
  Snapshot snapshot_;
  std::vector<std::optional<gdd::GoalMark>> marks_;
  std::vector<Snapshot::ContactForce> contacts_;  ///< of the last step
};

}  // namespace softgauss::io

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What events do to a run: they take hold of links, push them, switch goals, and move time.
///
/// Events come between steps. The same events at the same steps give the same run, bit for bit,
/// whether a person sent them or a file.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/live/drag.hpp"
#include "apps/live/keyframes.hpp"
#include "apps/live/names.hpp"
#include "apps/live/rewind.hpp"

namespace softgauss::live {

/// The parts of a run that events change. They outlive the hands.
struct RunParts {
  Model& model;
  State& state;
  long& instant;              ///< steps from the start to the state
  std::optional<Data>& data;  ///< made anew where the model's options change
  gdd::GoalDirectedController& controller;
};

class Hands {
 public:
  /// Gives the controller goals that begin when somebody takes hold; none to a passive run.
  /// `states` are those to which the run can be put by name; `fixedWorld` says why gravity and
  /// effects cannot change, and is empty where they can.
  Hands(const RunParts& run, bool passive, Keyframes::Named states = {},
        std::string fixedWorld = "");

  const Names& names() const { return *names_; }

  /// Does what the event says, which the names allow. Returns why it was refused; empty: done.
  std::string apply(const Event& event);
  /// The push, of whatever instant the kinematics are.
  void addWrench(const Kinematics& kinematics, std::vector<ExternalWrench>& wrenches) const;
  /// A step was taken.
  void afterStep() { rewind_.observe(run_.state, run_.instant); }

  bool paused() const { return paused_ && stepsLeft_ == 0; }
  /// Of a paused run: a step may be taken. To be called once a step.
  void takeStep() {
    if (stepsLeft_ > 0) --stepsLeft_;
  }
  double factor() const { return factor_; }
  /// The state has moved other than by a step since the last call.
  bool jumped() { return std::exchange(jumped_, false); }

  struct GoalView {
    std::string name, link;
    bool on = false;                   ///< not switched off
    bool acts = false;                 ///< at this time
    std::optional<double> start, end;  ///< [s]; absent: always
    bool canBegin = false;             ///< a drag that nobody holds
    std::optional<double> weight, stiffness, damping, rate;
    std::optional<double> duration;  ///< of the minimum-jerk line by which it comes [s]
    const char* weightUnit = "";
    bool weightIsDefault = false, rotationWeightIsDefault = false;  ///< nobody has given it
    std::optional<Vector3> point, target;                           ///< of a goal that is a place
    std::optional<Eigen::Quaterniond> orientation;
    std::optional<double> rotationWeight;  ///< of that
    std::optional<double> jerkStart;       ///< when the line of `duration` began [s]
    bool consistent = false;               ///< metric
  };
  std::vector<GoalView> goals() const;
  const Keyframes& keyframes() const { return *keyframes_; }
  const std::string& holding() const { return holding_; }  ///< name of the drag, or empty
  bool pushes() const { return push_.has_value(); }

  static constexpr int kDrags = 8;

 private:
  std::string act(const Event& event);
  std::string grab(const Event& event);
  std::string push(const Event& event);
  std::string setGoal(const Event& event);
  std::string moveTarget(const Event& event);
  std::string setJoint(const Event& event);
  std::string keyframe(const Event& event);
  std::string setWorld(const Event& event);
  void goTo(const Rewind::Place& place);
  void switchGoal(std::size_t index, bool on);
  void weighDefaults();
  Vector3 placeOf(const gdd::Reach& reach) const;
  Drag* held() const;

  struct Push {
    int body;
    Vector3 p_BP, force, torque;
  };

  RunParts run_;
  std::vector<Drag*> drags_;
  std::vector<double> starts_;  ///< of goals that are switched off
  std::unique_ptr<Names> names_;
  std::unique_ptr<Keyframes> keyframes_;
  Rewind rewind_;
  std::optional<Push> push_;
  std::string holding_;
  std::string fixedWorld_;
  bool paused_ = false, jumped_ = false;
  long stepsLeft_ = 0;
  double factor_ = 1.0;
};

}  // namespace softgauss::live

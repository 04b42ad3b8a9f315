// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where a plan is to end, as goals of the controller that acts it out. They cost no step anything:
/// they mark the places, and who moves them, as a live page does, moves the plan's targets.

#include <vector>

#include "softgauss/gdd/goal_directed_step.hpp"
#include "softgauss/io/plan_task.hpp"

namespace softgauss {

/// A place that a point of a link is to come to.
class PlanPlace final : public gdd::Goal {
 public:
  /// The link exists. One that is `fixed` cannot be moved.
  PlanPlace(const Model& model, const io::PlanTask::Point& point, bool fixed);

  std::string name() const override { return "plan " + link_; }
  bool steadyAt(double) const override { return false; }
  void addCost(const gdd::GoalContext&, gdd::GoalCost&) const override {}
  std::optional<gdd::GoalMark> mark(const gdd::GoalContext& context) const override;
  /// None: the plan is judged as a whole.
  void errors(const gdd::GoalContext&, const gdd::ContactForces&,
              std::vector<gdd::GoalError>&) const override {}
  double* soughtPlace() override { return fixed_ ? nullptr : target.data(); }
  bool isOf(const io::PlanTask::Point& point) const;

  Vector3 target;  ///< world [m]

 private:
  std::string link_;
  int frame_;
  Vector3 p_FP_;
  bool fixed_;
};

/// The configuration that it is to end in; its place is that of the first base that floats and
/// whose place the plan weighs.
class PlanPosture final : public gdd::Goal {
 public:
  PlanPosture(const Model& model, const io::PlanTask& task, bool fixed);

  std::string name() const override { return "plan"; }
  bool steadyAt(double) const override { return false; }
  void addCost(const gdd::GoalContext&, gdd::GoalCost&) const override {}
  std::optional<gdd::GoalMark> mark(const gdd::GoalContext& context) const override;
  void errors(const gdd::GoalContext&, const gdd::ContactForces&,
              std::vector<gdd::GoalError>&) const override {}
  double* soughtPlace() override;
  VectorX* soughtPositions() override { return fixed_ ? nullptr : &q; }

  VectorX q;  ///< (nq)

 private:
  int base_ = -1, frame_ = -1;  ///< body and its frame; −1: none
  int at_ = 0;                  ///< its place in q
  bool fixed_;
};

/// All targets of a task.
class PlanTargets {
 public:
  /// Adds them to the goals, which own them and must outlive this. `fixed`: they cannot be moved.
  void join(const Model& model, const io::PlanTask& task, bool fixed,
            std::vector<std::unique_ptr<gdd::Goal>>& goals);
  /// Gives the task those that were moved or switched since the last call; whether one was. A
  /// configuration that was moved is a target to rest at, at every knot; what is switched off
  /// weighs nothing.
  bool update(double time, io::PlanTask& task);

 private:
  struct Seen {
    VectorX q;
    std::vector<Vector3> places;
    std::vector<bool> acts;  ///< the configuration, then the places
  };
  bool isAsSeen(double time) const;
  Seen seen(double time) const;
  io::PlanTask::StateWeights at(const Seen& now, const io::PlanTask::StateWeights& given,
                                const std::vector<std::size_t>& placeOf) const;

  PlanPosture* posture_ = nullptr;
  std::vector<PlanPlace*> places_;
  io::PlanTask::StateWeights running_, final_;              ///< as the file has them
  std::vector<std::size_t> placeOfRunning_, placeOfFinal_;  ///< of their points
  Seen seen_;
};

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A spatial goal that begins when somebody takes hold of a point, equation (11) of the paper, and
/// ends when it is let go. The point comes by a virtual spring-damper, or along a minimum-jerk
/// trajectory, which goes on without a jump, from where it is, whenever the place moves.

#include <optional>

#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::live {

class Drag final : public gdd::Goal {
 public:
  Drag(const Model& model, int number);

  /// From now on the point of the link seeks `p_WTarget`. The link exists.
  /// Without a weight [kg] it weighs as a reach does.
  void begin(const Model& model, const std::string& link, const Vector3& p_FP,
             const Vector3& p_WTarget, std::optional<double> weight);
  /// Lets it come in `duration` [s] from p_W, at rest, at `time` [s].
  void followFrom(const Vector3& p_W, double time, double duration);
  /// From `time` on [s] the point seeks another place.
  void moveTo(const Vector3& p_WTarget, double time);
  void end() { startTime = kInfinity; }
  bool held() const { return startTime < kInfinity; }

  std::string name() const override { return name_; }
  bool steadyAt(double) const override { return false; }
  int linkFrame() const override { return reach.frame; }
  double* soughtPlace() override { return held() ? reach.soughtPlace() : nullptr; }
  void weighBeside(double posture) override { reach.weighBeside(posture); }
  std::optional<gdd::LedPlace> ledPlace() const override;
  void addCost(const gdd::GoalContext& context, gdd::GoalCost& cost) const override {
    reach.addCost(context, cost);
  }
  /// The place that is held, wherever the trajectory there is.
  std::optional<gdd::GoalMark> mark(const gdd::GoalContext& context) const override {
    return gdd::GoalMark{reach.frame, reach.position(context), reach.p_WTarget};
  }
  /// None while nobody holds it.
  void errors(const gdd::GoalContext& context, const gdd::ContactForces& contacts,
              std::vector<gdd::GoalError>& out) const override {
    if (held()) Goal::errors(context, contacts, out);
  }
  bool hasLaterErrors() const override { return true; }

  gdd::Reach reach;                ///< what it asks for while it is held
  std::optional<double> duration;  ///< of the trajectory by which it comes [s]; absent: it has none

 private:
  void comeFrom(const gdd::PointMotion& from, double time);

  std::string name_;
};

}  // namespace softgauss::live

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A spatial goal that begins when somebody takes hold of a point, equation (11) of the paper, and
/// ends when it is let go. The point comes by a virtual spring-damper, or along a minimum-jerk
/// line, which goes on without a jump, from where it is, whenever the place moves.

#include <optional>

#include "apps/live/begun_line.hpp"
#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::live {

class Drag final : public gdd::Goal {
 public:
  Drag(const Model& model, int number);

  /// From now on the point of the link seeks `p_WTarget`. The link exists.
  /// Without a weight [kg] it weighs as a reach does.
  void begin(const Model& model, const std::string& link, const Vector3& p_FP,
             const Vector3& p_WTarget, std::optional<double> weight);
  /// Lets it come along a line in `duration` [s] from p_W, at rest, at `time` [s].
  void followLine(const Vector3& p_W, double time, double duration);
  /// From `time` on [s] the point seeks another place.
  void moveTo(const Vector3& p_WTarget, double time);
  void end() { startTime = kInfinity; }
  bool held() const { return startTime < kInfinity; }

  std::string name() const override { return name_; }
  bool steadyAt(double) const override { return false; }
  int linkFrame() const override { return reach.frame; }
  void weighBeside(double posture) override { reach.weighBeside(posture); }
  std::optional<gdd::LedPlace> ledPlace() const override;
  void addCost(const gdd::GoalContext& context, gdd::GoalCost& cost) const override;
  std::optional<gdd::GoalMark> mark(const gdd::GoalContext& context) const override {
    return reach.mark(context);
  }
  /// None while nobody holds it.
  void errors(const gdd::GoalContext& context, const gdd::ContactForces& contacts,
              std::vector<gdd::GoalError>& out) const override {
    if (held()) reach.errors(context, contacts, out);
  }
  bool hasLaterErrors() const override { return true; }

  gdd::Reach reach;               ///< what it asks for while it is held
  std::optional<BegunLine> line;  ///< by which it comes; absent: spring-damper

 private:
  std::string name_;
};

}  // namespace softgauss::live

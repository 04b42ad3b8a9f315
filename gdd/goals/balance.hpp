// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Goals of a robot as a whole: its centre of mass, its momentum, its capture point.
///
/// All are rows of the centroidal momentum matrix A (2.8), m the robot's mass, x its centre of
/// mass, h = (p; k) its momentum about that:
///   centre of mass   ½ w |S (ẍ − ẍ* − k_p (x* − x) − k_d (ẋ* − ẋ))|²,   S: the chosen axes  (9.13)
///   momentum         ½ w_p |ṗ − β (p* − p)|² + ½ w_k |k̇ − β (k* − k)|²                      (9.14)
///   capture point    ½ w |ẍ − ẍ°|² over the horizontal axes                               (9.15)
/// The instantaneous capture point ξ = x + ẋ/ω₀, ω₀ = √(g/z), is where a robot with the height z of
/// its centre of mass over the ground would have to put its foot to come to rest (Pratt 2006). ẍ°
/// is the acceleration with which ξ̇ = ξ̇* − β (ξ − ξ*):
///   ξ̇ = ẋ + ẍ/ω₀ + ẋ ż/(2 ω₀ z)   ⟹   ẍ° = ω₀ (ξ̇* − β (ξ − ξ*) − ẋ) − ẋ ż/(2 z)
/// A goal is of one robot, drivenRobot() or another.

#include <array>
#include <optional>

#include "softgauss/engine/dynamics/centroidal.hpp"
#include "softgauss/gdd/goal.hpp"
#include "softgauss/gdd/goals/default_weight.hpp"
#include "softgauss/gdd/goals/trajectory.hpp"

namespace softgauss::gdd {

/// The robot (Body::robot) of the first actuated dof. Throws ModelError when nothing is actuated.
int drivenRobot(const Model& model);
/// Whether a tree is of a robot.
inline bool isOfRobot(const Model& model, int tree, int robot) {
  return model.bodies[idx(model.trees[idx(tree)].rootBody)].robot == robot;
}

/// The target x* is a PlaceTarget.
class CenterOfMass final : public Goal, public PlaceTarget {
 public:
  int robot;                                   ///< Body::robot
  std::array<bool, 3> axes{true, true, true};  ///< S: of x, y, z
  double weight;                               ///< w [kg]; default 2.5 × the robot's mass
  DefaultWeight defaultWeight;                 ///< of w
  double stiffness = 100.0;                    ///< k_p [1/s²]
  double damping = 20.0;                       ///< k_d [1/s]

  CenterOfMass(const Model& model, int robot, const Vector3& p_WTarget);

  std::string name() const override { return "center_of_mass"; }
  void weighBeside(double posture) override { defaultWeight.setBeside(posture, weight); }
  double* soughtPlace() override { return restingPlace(); }
  bool steadyAt(double time) const override { return !targetMovesAt(time); }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return isOfRobot(model, tree, robot);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
};

class MomentumGoal final : public Goal {
 public:
  int robot;                          ///< Body::robot
  Vector3 linear = Vector3::Zero();   ///< p* [kg m/s]
  Vector3 angular = Vector3::Zero();  ///< k* [kg m²/s]
  double linearWeight;                ///< w_p [1/kg]; default 2.5/m
  double angularWeight;               ///< w_k [1/(kg m²)]; default 10/m, in 1/m²
  double rate = 10.0;                 ///< β [1/s]

  MomentumGoal(const Model& model, int robot);

  std::string name() const override { return "momentum"; }
  bool restsAt(double) const override { return linear.isZero(0.0) && angular.isZero(0.0); }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return isOfRobot(model, tree, robot);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
};

/// The target ξ* is a PlaceTarget on the ground: z is the ground's height; its acceleration does
/// not count.
class CapturePoint final : public Goal, public PlaceTarget {
 public:
  int robot;                    ///< Body::robot
  double weight;                ///< w [kg]; default 2.5 × the robot's mass
  DefaultWeight defaultWeight;  ///< of w
  double rate = 5.0;            ///< β [1/s]

  CapturePoint(const Model& model, int robot, const Vector3& p_WTarget);

  /// ξ, at the ground's height; nothing when the centre of mass is not above the ground by 1 mm, or
  /// gravity does not pull down.
  std::optional<Vector3> position(const GoalContext& context) const;
  std::string name() const override { return "capture_point"; }
  void weighBeside(double posture) override { defaultWeight.setBeside(posture, weight); }
  double* soughtPlace() override { return restingPlace(); }
  bool steadyAt(double time) const override { return !targetMovesAt(time); }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return isOfRobot(model, tree, robot);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
  bool hasLaterErrors() const override { return true; }
};

}  // namespace softgauss::gdd

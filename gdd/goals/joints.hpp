// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Goals of chosen joints of one degree of freedom: target accelerations, and postures.
///
///   ℓ(a) = ½ w Σ_i M_ii (a_i − a*_i)²                                                    (9.8)
///   acceleration   a*_i given
///   posture        a*_i = q̈*_i + k_p (q*_i − q_i) + k_d (q̇*_i − v_i)                      (9.9)
/// over the chosen dofs i. M_ii, of the present configuration, is the inertia that joint i moves
/// when all others are locked: one w serves heavy and light joints. Joints that are not chosen are
/// free to move; a Posture of the whole robot (9.7) counts their motion too.

#include <algorithm>
#include <vector>

#include "softgauss/gdd/goal.hpp"
#include "softgauss/gdd/goals/trajectory.hpp"

namespace softgauss::gdd {

/// What a joint of one degree of freedom is to do.
struct JointTarget {
  int body = 0;        ///< that the joint carries
  double value = 0.0;  ///< a* [rad/s² or m/s²], q* [rad or m], v* [rad/s or m/s]
  // Of postures, whose target may move:
  double velocity = 0.0;      ///< q̇* [rad/s or m/s], for who moves q* himself
  double acceleration = 0.0;  ///< q̈* [rad/s² or m/s²], likewise
  std::shared_ptr<const Trajectory> trajectory{};  ///< q*(t); it replaces these
  int coordinate = 0;                              ///< of the trajectory

  CoordinateMotion positionAt(double time) const {
    return trajectory ? trajectory->at(time, coordinate)
                      : CoordinateMotion{value, velocity, acceleration};
  }
  bool movesAt(double time) const {
    return trajectory ? trajectory->movesAt(time) : velocity != 0.0 || acceleration != 0.0;
  }
};

/// The target of a named joint. Throws ModelError when the model has no such joint, or when it has
/// not one degree of freedom.
JointTarget jointTarget(const Model& model, const std::string& joint, double value);

/// Whether some of these joints are of a tree.
inline bool areOfTree(const Model& model, const std::vector<JointTarget>& targets, int tree) {
  return std::ranges::any_of(
      targets, [&](const JointTarget& t) { return model.bodies[idx(t.body)].tree == tree; });
}

/// Whether nothing but zero is asked for: of speeds or accelerations.
inline bool areZero(const std::vector<JointTarget>& targets) {
  return std::ranges::all_of(targets, [](const JointTarget& t) { return t.value == 0.0; });
}

class JointAcceleration final : public Goal {
 public:
  std::vector<JointTarget> targets;  ///< a*
  double weight = 1000.0;            ///< w [-]

  std::string name() const override { return "acceleration"; }
  bool restsAt(double) const override { return areZero(targets); }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return areOfTree(model, targets, tree);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
};

class JointPosture final : public Goal {
 public:
  std::vector<JointTarget> targets;  ///< q*
  double weight = 1000.0;            ///< w [-]
  double stiffness = 50.0;           ///< k_p [1/s²]
  double damping = 15.0;             ///< k_d [1/s]

  std::string name() const override { return "joint_posture"; }
  bool steadyAt(double time) const override;
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return areOfTree(model, targets, tree);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
};

}  // namespace softgauss::gdd

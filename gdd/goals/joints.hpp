// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Goals of chosen joints of one degree of freedom: target accelerations, and postures.
///
///   ℓ(a) = ½ w Σ_i M_ii (a_i − a*_i)²                                                    (9.8)
///   acceleration   a*_i given
///   posture        a*_i = k_p (q*_i − q_i) − k_d v_i                                      (9.9)
/// over the chosen dofs i. M_ii, of the present configuration, is the inertia that joint i moves
/// when all others are locked: one w serves heavy and light joints. Joints that are not chosen are
/// free to move; a Posture of the whole robot (9.7) counts their motion too.

#include <vector>

#include "softgauss/gdd/goal.hpp"

namespace softgauss::gdd {

/// What a joint of one degree of freedom is to do.
struct JointTarget {
  int body = 0;        ///< that the joint carries
  double value = 0.0;  ///< a* [rad/s² or m/s²], q* [rad or m]
};

/// The target of a named joint. Throws ModelError when the model has no such joint, or when it has
/// not one degree of freedom.
JointTarget jointTarget(const Model& model, const std::string& joint, double value);

class JointAcceleration final : public Goal {
 public:
  std::vector<JointTarget> targets;  ///< a*
  double weight = 1000.0;            ///< w [-]

  std::string name() const override { return "acceleration"; }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  std::unique_ptr<Goal> within(const Model& whole, const SubModel& island) const override;
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
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  std::unique_ptr<Goal> within(const Model& whole, const SubModel& island) const override;
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
};

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Chosen joints of one degree of freedom turn, or slide, at given speeds: wheels, conveyors.
///
///   ℓ(a) = ½ w Σ_i M_ii (a_i − β (v*_i − v_i))²                                           (9.28)
/// so that v* − v decays at the rate β. M_ii is that of (9.8): what the joint moves when all others
/// are locked.

#include "softgauss/gdd/goals/joints.hpp"

namespace softgauss::gdd {

class JointVelocity final : public Goal {
 public:
  std::vector<JointTarget> targets;  ///< v*
  double weight = 1000.0;            ///< w [-]
  double rate = 20.0;                ///< β [1/s]

  std::string name() const override { return "joint_velocity"; }
  bool restsAt(double) const override { return areZero(targets); }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return areOfTree(model, targets, tree);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
};

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Centre of pressure: the contact forces that the world exerts on a robot, or on some of its
/// links, act as if at a given place p*.
///
///   ℓ_f(a) = ½ w |Π m|²,   m = Σ_i (p_i − p*) × f_i + m_i,   Π = 1 − n nᵀ                 (9.21)
/// f_i, m_i: force and moment of contact i at p_i; n: upwards, against gravity. The centre of
/// pressure p on the plane through p* across n has Π m = (p − p*) × n f_n, f_n the force along n:
/// the residual is the distance from p* times the load, zero exactly where p = p*. Undivided by f_n
/// it is linear in the forces. Without load it is zero too: other goals must keep the robot on the
/// ground.

#include <optional>

#include "softgauss/gdd/goals/contact_selection.hpp"

namespace softgauss::gdd {

class CenterOfPressure final : public Goal {
 public:
  ContactSelection contacts;  ///< on the robot's geometries, by those of the world
  Vector3 p_WTarget;          ///< p* [m]
  Vector3 n_W;                ///< n, of length 1
  double weight;              ///< w [1/(kg m²)]; default 10 over the robot's mass, in 1/m²

  /// `robot`: Body::robot.
  CenterOfPressure(const Model& model, int robot, const Vector3& p_WTarget);
  /// Counts contacts of these links only. Throws ModelError when the model lacks one, or one cannot
  /// touch anything.
  void countOnly(const Model& model, const std::vector<std::string>& links);

  std::string name() const override { return "center_of_pressure"; }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return contacts.concerns(model, tree);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
  bool hasLaterErrors() const override { return true; }
  /// p, of the rows' present forces: after a step, those that acted in it [m]. Nothing where the
  /// contacts do not push up.
  std::optional<Vector3> measured(const Data& data) const;
};

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Look-at: an axis of a link points at a place in the world.
///
/// u is the axis, through the point p of the link; d = (p* − p)/r the direction of the place,
/// r = |p* − p|. Both turn: u with the link, at ω; d because p and p* move, at
///   ω_d = d × ḋ,   α_d = d × d̈ = d × (p̈* − p̈ − 2 ṙ ḋ)/r,   ḋ = (ṗ* − ṗ − ṙ d)/r,   ṙ = d·(ṗ* − ṗ)
/// The cost asks the angle θ between them, taken as the rotation vector that turns u into d the
/// shorter way, to decay as a spring-damper:
///   ℓ(a) = ½ w |Π (ω̇ − α_d − k_p θ + k_d (ω − ω_d))|²,   Π = 1 − u uᵀ                    (9.10)
/// ω̇ and p̈ are affine in a; rolling about u is free. A place nearer than 1 mm has no direction:
/// then the goal asks for nothing. Where u points away from the place, any axis across is taken.

#include "softgauss/gdd/goals/default_weight.hpp"
#include "softgauss/gdd/goals/link_rows.hpp"
#include "softgauss/gdd/goals/trajectory.hpp"

namespace softgauss::gdd {

/// The target is a PlaceTarget.
class LookAt final : public Goal, public PlaceTarget {
 public:
  std::string link;                ///< for the name
  int frame = 0;                   ///< index into Model::frames
  Vector3 axis_F;                  ///< u in the link's frame, length 1
  Vector3 p_FP = Vector3::Zero();  ///< p in the link's frame [m]
  double weight;                   ///< w [kg m²]; default 0.025 m² × referenceMass()
  DefaultWeight defaultWeight;     ///< of w
  double stiffness = 100.0;        ///< k_p [1/s²]
  double damping = 20.0;           ///< k_d [1/s]

  /// `axis` need not have length 1. Throws ModelError when the model has no such link, or where
  /// axis is zero.
  LookAt(const Model& model, const std::string& link, const Vector3& p_WTarget,
         const Vector3& axis = Vector3::UnitX(), const Vector3& p_FP = Vector3::Zero());

  std::string name() const override { return "look_at " + link; }
  int linkFrame() const override { return frame; }
  void weighBeside(double posture) override { defaultWeight.setBeside(posture, weight); }
  bool steadyAt(double time) const override { return !targetMovesAt(time); }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return isOfTree(model, frame, tree);
  }
  double* soughtPlace() override { return restingPlace(); }
  /// The point on the axis that is as far as the place, and the place.
  std::optional<GoalMark> mark(const GoalContext& context) const override;
};

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A given acceleration of a point of a link, and of the link's rotation: equation (11) of the
/// paper as it stands, for callers with a law of their own.
///
///   ℓ(a) = ½ w |J a + J̇ v − a*|² + ½ w_r |J_r a + J̇_r v − α*|²                           (9.12)
///
/// The metric may be the consistent one (9.5) instead of the Euclidean.

#include <optional>

#include "softgauss/gdd/goals/default_weight.hpp"
#include "softgauss/gdd/goals/link_rows.hpp"

namespace softgauss::gdd {

class LinkAcceleration final : public Goal {
 public:
  std::string link;                     ///< for the name
  int frame = 0;                        ///< index into Model::frames
  Vector3 p_FP = Vector3::Zero();       ///< the point in the link's frame [m]
  Vector3 linear;                       ///< a* of the point, world axes [m/s²]
  std::optional<Vector3> angular;       ///< α* of the link, world axes [rad/s²]; absent: any
  double weight;                        ///< w [kg; - if consistent]; default 2.5 × referenceMass()
  double rotationWeight;                ///< w_r [kg m²; - if consistent]; default 0.01 m² × w
  DefaultWeight defaultWeight;          ///< of w
  DefaultWeight defaultRotationWeight;  ///< of w_r
  LinkMetric metric = LinkMetric::euclidean;

  /// Throws ModelError when the model has no such link.
  LinkAcceleration(const Model& model, const std::string& link, const Vector3& linear,
                   const Vector3& p_FP = Vector3::Zero());

  std::string name() const override { return "acceleration of " + link; }
  int linkFrame() const override { return frame; }
  bool restsAt(double) const override {
    return linear.isZero(0.0) && (!angular || angular->isZero(0.0));
  }
  void weighBeside(double posture) override {
    defaultWeight.setBeside(posture, weight);
    defaultRotationWeight.setBeside(posture, rotationWeight);
  }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return isOfTree(model, frame, tree);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
};

}  // namespace softgauss::gdd

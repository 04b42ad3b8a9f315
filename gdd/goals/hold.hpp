// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Hold: a point of a link, or the whole link, does not move; the no-slip goal of a placed foot.
///
///   ℓ(a) = ½ w |p̈ + β ṗ|² + ½ w_r |ω̇ + β ω|²                                            (9.11)
/// What velocity there is decays at the rate β. No place is named: unlike a Reach, the goal does
/// not pull a foot that has slipped back to where it was. For a point the second term is absent.

#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {

class Hold final : public Goal {
 public:
  std::string link;                     ///< for the name
  int frame = 0;                        ///< index into Model::frames
  Vector3 p_FP = Vector3::Zero();       ///< the point in the link's frame [m]
  bool wholeLink = true;                ///< false: the point only
  double weight;                        ///< w [kg]; default 2.5 × referenceMass()
  double rotationWeight;                ///< w_r [kg m²]; default 0.01 m² × w
  DefaultWeight defaultWeight;          ///< of w
  DefaultWeight defaultRotationWeight;  ///< of w_r
  double rate = 20.0;                   ///< β [1/s]

  /// Throws ModelError when the model has no such link.
  Hold(const Model& model, const std::string& link);

  std::string name() const override { return "hold " + link; }
  int linkFrame() const override { return frame; }
  void weighBeside(double posture) override {
    defaultWeight.setBeside(posture, weight);
    defaultRotationWeight.setBeside(posture, rotationWeight);
  }
  std::optional<LedPlace> ledPlace() const override {
    if (!defaultWeight.isAt(weight)) return std::nullopt;
    return LedPlace{frame, p_FP, wholeLink, startTime, endTime};
  }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override {
    return isOfTree(model, frame, tree);
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
};

}  // namespace softgauss::gdd

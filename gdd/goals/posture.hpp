// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Posture: every joint and floating base seeks a reference configuration, as a spring-damper.
///
///   ℓ(a) = ½ w (a − a*)ᵀ M (a − a*),   a* = k_p (q* ⊖ q) − k_d v                         (9.7)
/// in the metric M, so that one weight serves heavy and light joints. ⊖ is the difference on the
/// configuration manifold. With R = M⁻¹ torques at light links are dear: a weight of 10³ makes a
/// standing humanoid stay up.

#include <utility>

#include "softgauss/gdd/goal.hpp"

namespace softgauss::gdd {

class Posture final : public Goal {
 public:
  static constexpr double kDefaultWeight = 1000.0;

  VectorX q;                       ///< q* (nq)
  double weight = kDefaultWeight;  ///< w [-]
  double stiffness = 50.0;         ///< k_p [1/s²]
  double damping = 15.0;           ///< k_d [1/s]

  explicit Posture(VectorX reference) : q(std::move(reference)) {}

  std::string name() const override { return "posture"; }
  void addCost(const GoalContext& context, GoalCost& cost) const override {
    VectorX& away = cost.workspace().dofs;
    positionDifference(context.model, context.state.q, q, away);
    cost.addMetric(weight, context.data.inertia.M, stiffness * away - damping * context.state.v);
  }
  std::unique_ptr<Goal> within(const Model& whole, const SubModel& island) const override {
    auto goal = std::make_unique<Posture>(*this);  // M ties nothing that is apart
    island.gatherPosition(whole, q, goal->q);
    return goal;
  }
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
};

}  // namespace softgauss::gdd

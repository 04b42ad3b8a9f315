// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Virtual damping, equation (26) of the paper: tells the robot to stop moving.
///
///   ℓ(a) = ½ α (a + β v)ᵀ M (a + β v)                                                   (T.24)
/// M is the metric that matches the units of accelerations, as R = M⁻¹ does for forces.

#include "gdd/goal.hpp"

namespace softgauss::gdd {

class VirtualDamping final : public Goal {
 public:
  double weight = 0.1;  ///< α [-]
  double rate = 10.0;   ///< β [1/s]

  std::string name() const override { return "damping"; }
  void addCost(const GoalContext& context, GoalCost& cost) const override {
    cost.addMetric(weight, context.data.inertia.M, -rate * context.state.v);
  }
};

}  // namespace softgauss::gdd

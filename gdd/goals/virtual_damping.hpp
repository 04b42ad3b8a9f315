// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Virtual damping, equation (26) of the paper: tells the robot to stop moving.
///
///   ℓ(a) = ½ α (a + β v)ᵀ W (a + β v),   W = M, or R = M⁻¹                                (9.6)
/// M is the metric that matches the units of accelerations, as R = M⁻¹ does for forces. With R the
/// heaviest motions are damped least.

#include "softgauss/gdd/goal.hpp"

namespace softgauss::gdd {

/// W of virtual damping.
enum class DampingMetric {
  inertia,        ///< M
  inverseInertia  ///< R = M⁻¹
};

class VirtualDamping final : public Goal {
 public:
  double weight = 1.0;  ///< α [-]; with M⁻¹ in the units of M²
  double rate = 10.0;   ///< β [1/s]
  DampingMetric metric = DampingMetric::inertia;

  std::string name() const override { return "damping"; }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
};

}  // namespace softgauss::gdd

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Costs that the user writes: any smooth function of the acceleration, and value functions.
///
///   function   ℓ(a) = φ(a)
///   value      ℓ(a) = w V(q ⊕ h v, v + h a)        equation (22) of the paper             (9.17)
///              ∇ℓ = w h ∂V/∂v,   ∇²ℓ = w h² ∂²V/∂v²   at the next state
/// The next state's q does not depend on a, so only derivatives in v are asked for. h is the time
/// step. The next state is that of (19); the integrator's differs by damping (7.1).
///
/// φ and V need not be quadratic, nor convex: see sequential_quadratic_solve.hpp for how they are
/// minimised. Functions are called up to some hundreds of times a step; they must not throw. With
/// them the step allocates.

#include <functional>

#include "softgauss/gdd/goal.hpp"

namespace softgauss::gdd {

class FunctionGoal final : public Goal {
 public:
  /// Returns φ(a) [kg m²/s⁴] and writes ∇φ (nv) and ∇²φ (nv × nv, symmetric), which have their
  /// size.
  using Function = std::function<double(const GoalContext& context, const VectorX& a,
                                        VectorX& gradient, MatrixX& hessian)>;
  Function function;

  explicit FunctionGoal(Function f) : function(std::move(f)) {}
  std::string name() const override { return "function"; }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
};

class ValueGoal final : public Goal {
 public:
  /// Returns V(q, v) and writes ∂V/∂v (nv) and ∂²V/∂v² (nv × nv, symmetric), which have their size.
  using Value = std::function<double(const VectorX& q, const VectorX& v, VectorX& gradient,
                                     MatrixX& hessian)>;
  Value value;
  double weight = 1.0;  ///< w

  explicit ValueGoal(Value V) : value(std::move(V)) {}
  std::string name() const override { return "value"; }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
};

}  // namespace softgauss::gdd

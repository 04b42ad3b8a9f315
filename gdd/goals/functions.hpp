// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Costs that the user writes: any smooth function of the acceleration, and value functions.
///
///   function   ℓ(a) = φ(a)
///   value      ℓ(a) = w V(q⁺, v⁺)        equation (22) of the paper                      (9.17)
///              ∇ℓ = w Bᵀ∇V,   ∇²ℓ ≈ w Bᵀ∇²V B,   B = ∂(q⁺, v⁺)/∂a   at the next state
/// The next state is that of the step, next_state.hpp: in the leapfrog q⁺ depends on a too, by
/// ½ h² a. What the curvature leaves out is of the rotations of floating joints, of O(h³) ∇V.
///
/// φ and V need not be quadratic, nor convex: see sequential_quadratic_solve.hpp for how they are
/// minimised. Functions are called up to some hundreds of times a step; they must not throw. With
/// them the step allocates. A V that is quadratic is quadratic_value.hpp.

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
  /// Returns V(q, v) and writes its gradient (2 nv), by the tangent of q and by v, and its second
  /// derivatives (2 nv × 2 nv, symmetric), which have their size.
  using Value = std::function<double(const VectorX& q, const VectorX& v, VectorX& gradient,
                                     MatrixX& hessian)>;
  Value value;
  double weight = 1.0;  ///< w

  explicit ValueGoal(Value V) : value(std::move(V)) {}
  std::string name() const override { return "value"; }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
};

}  // namespace softgauss::gdd

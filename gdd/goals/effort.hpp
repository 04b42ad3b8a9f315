// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Effort: what the control of chosen dofs costs besides the control cost ½ gᵀR g.
///
///   ½ Σ_i w ŵ_i g_i(a)²                                                                  (9.16)
/// over the chosen dofs; ŵ_i is the dof's inverse inertia w_i of (2.7), constant, so that w is a
/// plain number: with w = 1 a joint's force costs about twice what it costs anyway. g is the
/// inverse dynamics, so this is no function of a alone but a term of the price, R + diag(w ŵ).
///
/// Over root forces z, ½ Σ_k w ŵ_k z_k² with ŵ_k = Σ_i Z_ik² ŵ_i, it has an effect only where they
/// are allowed: ControlLimits::allowRootForces(). With w → ∞ the solution tends to that of g_z = 0,
/// the paper's continuation; what is found at a finite w is applied as it is, root forces included.

#include <string>
#include <vector>

#include "softgauss/gdd/goal.hpp"
#include "softgauss/gdd/problem.hpp"

namespace softgauss::gdd {

class Effort final : public Goal {
 public:
  std::vector<int> dofs;  ///< that pay
  MatrixX directions;     ///< (nv × any) unit columns c_k: forces c_k·g pay too
  double weight = 1.0;    ///< w [-]

  explicit Effort(std::vector<int> chosen) : dofs(std::move(chosen)) {}
  /// All actuated dofs; all others, whose forces are root forces.
  static std::vector<int> actuatedDofs(const Model& model);
  static std::vector<int> rootDofs(const Model& model);
  /// Of all forces that no actuator of the limits causes: single dofs, and directions among dofs
  /// that fewer actuators pull together.
  static Effort rootForces(const Model& model, const ControlLimits& limits);

  std::string name() const override { return "effort"; }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override;
};

}  // namespace softgauss::gdd

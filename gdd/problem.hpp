// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The goal directed dynamics problem in its inverse form, equation (8) of the paper:
///
///   min_a  ½ g(a)ᵀ R g(a) + ℓ(a)   subject to  lower ≤ g(a) ≤ upper,   R = M⁻¹            (T.17)
///
/// g is the inverse dynamics (T.2). An unactuated dof has lower = upper = 0 (the paper's g_z = 0),
/// an actuated one its effort box, or no bound. A solution is an acceleration that the actuators
/// can cause, with contact forces that the physics agrees to.

#include "engine/model/model.hpp"

namespace softgauss::gdd {

struct ControlBox {
  VectorX lower;  ///< (nv) [N or N m]
  VectorX upper;

  ControlBox() = default;
  explicit ControlBox(const Model& model) : lower(model.nv), upper(model.nv) {
    const bool actuation = model.options.effects.has(Effect::actuation);
    for (int i = 0; i < model.nv; ++i) {
      const Dof& dof = model.dofs[i];
      const bool free = actuation && dof.actuated;
      lower[i] = free ? dof.effortLower : 0.0;
      upper[i] = free ? dof.effortUpper : 0.0;
    }
  }
  /// Opens the box of every unactuated dof: root forces are then allowed, and applied.
  void allowRootForces(const Model& model) {
    for (int i = 0; i < model.nv; ++i)
      if (!model.dofs[i].actuated) lower[i] = -kInfinity, upper[i] = kInfinity;
  }
  /// Distance of g from the box, largest component [N or N m].
  double violation(const VectorX& g) const {
    return (g - g.cwiseMax(lower).cwiseMin(upper)).cwiseAbs().maxCoeff();
  }
  VectorX clamp(const VectorX& g) const { return g.cwiseMax(lower).cwiseMin(upper); }
};

}  // namespace softgauss::gdd

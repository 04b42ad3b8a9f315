// SPDX-License-Identifier: Apache-2.0
#pragma once

/// M + h ∂(smooth forces)/∂v, factored; memory of the implicit integrators.

#include "softgauss/engine/dynamics/tree_lu.hpp"
#include "softgauss/engine/step/data.hpp"

namespace softgauss {

struct VelocityDerivative {
  explicit VelocityDerivative(const Model& model) : coriolis(model) {}

  CoriolisDerivative coriolis;
  TreePair matrix;
  TreeLu lu;

  /// Of M + scale C + diagonal (null: none) at the velocity of data.kinematics; false where it
  /// cannot be (tree_lu.hpp).
  bool factorize(const Model& model, const Data& data, double scale, const VectorX* diagonal) {
    coriolis.addTo(model, data.kinematics, data.inertia, scale, matrix);
    if (diagonal)
      for (int i = 0; i < model.nv; ++i) {
        matrix.lower.row(i)[i] += (*diagonal)[i];
        matrix.upper.row(i)[i] += (*diagonal)[i];
      }
    return lu.compute(model, matrix);
  }
  /// x ← A⁻¹ x.
  void solve(const Model& model, VectorX& x) const { lu.solve(model, matrix, x); }
};

inline bool isImplicit(Integrator integrator) {
  return integrator == Integrator::implicit || integrator == Integrator::implicitMidpoint;
}

}  // namespace softgauss

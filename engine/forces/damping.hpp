// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Viscous joint damping: force −d v on each dof, so c gains d v. The Euler step treats it
/// implicitly, see integrators/semi_implicit_euler.hpp.

#include "engine/model/model.hpp"

namespace softgauss {

inline bool hasDamping(const Model& model) {
  if (!model.options.effects.has(Effect::damping)) return false;
  for (const Dof& dof : model.dofs)
    if (dof.damping > 0.0) return true;
  return false;
}

inline void addDamping(const Model& model, const VectorX& v, VectorX& c) {
  if (!model.options.effects.has(Effect::damping)) return;
  for (int i = 0; i < model.nv; ++i) c[i] += model.dofs[i].damping * v[i];
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/dry_friction.hpp"

#include "engine/constraints/impedance.hpp"

namespace softgauss {

void DryFriction::assemble(const Assembly& in) {
  const Model& model = in.model;
  dof_.clear();
  clearRows();
  if (model.options.effects.has(Effect::dryFriction)) {
    for (int i = 0; i < model.nv; ++i) {
      const Dof& dof = model.dofs[i];
      if (dof.dryFriction == 0.0) continue;
      const Softness soft =
          softnessAt(dof.frictionImpedance, 0.0, in.weights.dof[i], model.options.timestep);
      dof_.push_back(i);
      reference.push_back(soft.referenceAcceleration(in.state.v[i], 0.0));
      pushSoftness(soft);
      limit.push_back(dof.dryFriction);
    }
  }
  resizeRows(dof_.size());
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/dry_friction.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/constraints/law/row_law.hpp"

namespace softgauss {
namespace {

/// (5.6): a joint that hardly moves sticks. `rate` = |v|, `limit` = f_max.
void harden(Softness& soft, double rate, double limit) {
  constexpr double kAtRest = 1e-9;  // of R: a joint at rest
  if (!(soft.damping > 0.0)) return;
  const double slow = 2.0 * limit * soft.R / soft.damping;
  if (!(rate < slow)) return;  // also NaN
  const double share = std::max(kAtRest, rate / slow);
  soft.R = std::max(kSmallestRegulariser, share * soft.R);
  soft.perInertia *= share;
}

}  // namespace

void DryFriction::assemble(const Assembly& in) {
  const Model& model = in.model;
  clear();
  if (model.options.effects.has(Effect::dryFriction)) {
    for (int i = 0; i < model.nv; ++i) {
      const Dof& dof = model.dofs[i];
      if (dof.dryFriction == 0.0 || !in.takesPart(dof.body)) continue;
      const double rate = in.state.v[i];
      const double A = in.weights.dof[i];
      Softness soft = model.options.hasRowLaw()
                          ? frictionLaw(dof.frictionImpedance, A, model.options)
                          : softnessAt(dof.frictionImpedance, 0.0, A, model.options.rowTimestep());
      if (model.options.uses(Mechanism::stiction) && !in.controlled(dof.body))
        harden(soft, std::abs(rate), dof.dryFriction);
      push(i, 1.0, soft, soft.referenceAcceleration(rate, 0.0));
      limit.push_back(dof.dryFriction);
    }
  }
  finish();
}

}  // namespace softgauss

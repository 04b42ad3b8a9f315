// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/joint_limit.hpp"

#include "engine/constraints/impedance.hpp"

namespace softgauss {

void JointLimit::assemble(const Assembly& in) {
  const Model& model = in.model;
  dof_.clear();
  sign_.clear();
  clearRows();
  if (model.options.effects.has(Effect::jointLimit)) {
    for (const JointRange& range : model.ranges) {
      const Body& body = model.bodies[range.body];
      for (const double sign : {1.0, -1.0}) {
        const double bound = sign > 0.0 ? range.lower : range.upper;
        const double r = sign * (in.state.q[body.q] - bound) - range.margin;
        if (!(r < 0.0)) continue;
        const Softness soft = softnessAt(range.impedance, r, in.weights.dof[body.v], model.options);
        dof_.push_back(body.v);
        sign_.push_back(sign);
        reference.push_back(soft.referenceAcceleration(sign * in.state.v[body.v], r));
        pushSoftness(soft);
      }
    }
  }
  resizeRows(dof_.size());
}

}  // namespace softgauss

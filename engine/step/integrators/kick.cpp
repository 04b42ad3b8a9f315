// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/kick.hpp"

#include <algorithm>

#include "softgauss/engine/step/forward.hpp"

namespace softgauss {

bool tooFast(const Model& model, const VectorX& v) {
  if (!v.allFinite()) return true;
  return std::any_of(model.trees.begin(), model.trees.end(), [&](const Tree& tree) {
    const Body& root = model.bodies[static_cast<std::size_t>(tree.rootBody)];
    return root.joint == JointKind::floating &&
           v.segment<3>(root.v + 3).cwiseAbs().maxCoeff() > 1e150;
  });
}

bool addGeometricStiffness(const Model& model, Data& data, const State& state) {
  data.stats.stabilisedBodies = data.constraints.addGeometricStiffness(
      {model, state, data.kinematics, data.contacts, data.weights, data.inertia.sparsity});
  if (data.stats.stabilisedBodies == 0) return true;
  data.acceleration = data.forward.a;
  forwardDynamics(model, &data.acceleration, data);
  return data.stats.count(data.forward.report);
}

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/kick.hpp"

#include <algorithm>

namespace softgauss {

bool tooFast(const Model& model, const VectorX& v) {
  if (!v.allFinite()) return true;
  return std::any_of(model.trees.begin(), model.trees.end(), [&](const Tree& tree) {
    const Body& root = model.bodies[static_cast<std::size_t>(tree.rootBody)];
    return root.joint == JointKind::floating &&
           v.segment<3>(root.v + 3).cwiseAbs().maxCoeff() > 1e150;
  });
}

void keepConnectionForces(const Model& model, Data& data, State& state,
                          std::span<const std::uint8_t> trees) {
  if (data.plan.rows.has(RowKind::geometricStiffness))
    data.constraints.connectionForces(model, data.kinematics, trees, state.connectionForces);
}

}  // namespace softgauss

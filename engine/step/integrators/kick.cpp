// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/kick.hpp"

#include <algorithm>

#include "softgauss/engine/core/segment_vectors.hpp"

namespace softgauss {

bool tooFast(const Model& model, const TreeSelection& trees, const VectorX& v) {
  if (!allFinite(trees.dofs(), v)) return true;
  return std::ranges::any_of(trees.trees(), [&](int tree) {
    const Body& root = model.bodies[idx(model.trees[idx(tree)].rootBody)];
    return root.joint == JointKind::floating &&
           v.segment<3>(root.v + 3).cwiseAbs().maxCoeff() > 1e150;
  });
}

void keepConnectionForces(const Model& model, Data& data, State& state,
                          std::span<const std::uint8_t> trees) {
  if (trees.empty() && !data.active.all()) trees = data.active.flags();
  if (data.plan.rows.has(RowKind::geometricStiffness))
    data.constraints.connectionForces(model, data.kinematics, trees, state.connectionForces);
}

}  // namespace softgauss

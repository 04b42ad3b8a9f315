// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/nearby_poses.hpp"

#include <algorithm>

namespace softgauss {

bool NearbyPoses::assemble(const Model& model, const State& state, const Kinematics& k) {
  const double h = model.options.timestep, slow = 1e-3 / h;
  if (std::all_of(k.V.begin(), k.V.end(),
                  [&](const Motion& V) { return V.angular.squaredNorm() <= slow * slow; }))
    return false;
  if (before.X_WB.size() != model.bodies.size()) before = after = Kinematics(model);
  q_ = state.q;
  integratePosition(model, state.v, -h, q_);
  computePoses(model, q_, before);
  q_ = state.q;
  integratePosition(model, state.v, h, q_);
  computePoses(model, q_, after);
  return true;
}

}  // namespace softgauss

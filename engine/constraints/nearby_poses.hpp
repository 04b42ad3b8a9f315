// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Where a leapfrog comes from, q ⊖ h v, and where it would go if nothing accelerated it, q ⊕ h v:
/// what a distance that turns far in a step needs to tell how it has changed (T.116).

#include "engine/dynamics/kinematics.hpp"

namespace softgauss {

struct NearbyPoses {
  Kinematics before, after;  ///< poses at q ⊖ h v and at q ⊕ h v

  /// False, and nothing is worked out, where no body turns by a thousandth of a radian in the step.
  bool assemble(const Model& model, const State& state, const Kinematics& k);

 private:
  VectorX q_;
};

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How near a chain of joints can bring a point of a link to a place, whatever forces it takes.

#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss::app {

struct ReachLimit {
  double freely = 0.0;        ///< least distance that was found, hinges turning without end [m]
  double withinRanges = 0.0;  ///< the same with every joint within its range [m]
};

/// Looks for the least distance of the point p_FP of frame `frame` from p_WTarget over the joints
/// between the base and the frame; the base stays as it is in `q` (nq). A search from there and
/// from some twenty other configurations, so a little more may be possible than it finds.
ReachLimit reachLimit(const Model& model, const VectorX& q, int frame, const Vector3& p_FP,
                      const Vector3& p_WTarget);

}  // namespace softgauss::app

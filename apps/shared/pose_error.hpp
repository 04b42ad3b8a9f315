// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far two states of a model are apart, in metres:
///
///   e² = mean over links of |Δp|² + (ρ Δθ)²
///
/// p: a link's centre of mass; ρ: its radius of gyration, ρ² = tr I/(3 m); Δθ: the angle between
/// its two orientations. Links without mass are not counted.

#include "softgauss/engine/engine.hpp"

namespace softgauss::app {

struct PoseError {
  double total = 0.0;        ///< e [m]
  double orientation = 0.0;  ///< root mean square of Δθ alone [rad]
};

/// Poses of all links with mass.
class LinkPoses {
 public:
  explicit LinkPoses(const Model& model);
  void set(const State& state);
  PoseError against(const LinkPoses& other) const;

 private:
  const Model* model_;
  Kinematics kinematics_;
  std::vector<int> bodies_;
  std::vector<double> rho_;
  std::vector<Vector3> p_;
  std::vector<Matrix3> R_;
};

}  // namespace softgauss::app

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Mechanical energy and momentum of the moving bodies.

#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

struct Energy {
  double kinetic = 0.0;  ///< ½ vᵀM v, armature included [J]
  double potential = 0.0;  ///< −Σ m gᵀ p_com, zero at the world's origin, and Σ ½ k (q − q_s)² [J]
  double total() const { return kinetic + potential; }
};

Energy computeEnergy(const Model& model, const Kinematics& kinematics, const VectorX& q,
                     const VectorX& v);

/// Linear momentum [kg m/s] and angular momentum about the world's origin [kg m²/s].
struct Momentum {
  Vector3 linear = Vector3::Zero();
  Vector3 angular = Vector3::Zero();
};

Momentum computeMomentum(const Model& model, const Kinematics& kinematics);

/// Centre of mass of all moving bodies [m], world.
Vector3 centerOfMass(const Model& model, const Kinematics& kinematics);

}  // namespace softgauss

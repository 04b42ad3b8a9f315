// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Recursive Newton–Euler algorithm (Featherstone 2008, section 5.3): bias forces and inverse
/// dynamics of the tree without constraints,  τ = M v̇ + b  (2.2).

#include <vector>

#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

/// Scratch of the recursion.
struct RneaWorkspace {
  std::vector<Motion> V;  ///< (bodies)
  std::vector<Motion> A;  ///< (bodies)
  std::vector<Force> F;   ///< (bodies) force transmitted by the joint
  RneaWorkspace() = default;
  explicit RneaWorkspace(const Model& model) : RneaWorkspace(model, true, true) {}
  /// Memory for computeBias(), and for what takes another velocity or acceleration.
  RneaWorkspace(const Model& model, bool bias, bool otherVelocity)
      : V(otherVelocity ? model.bodies.size() : 0),
        A(otherVelocity ? model.bodies.size() : 0),
        F(bias ? model.bodies.size() : 0) {}
};

/// Bias force b(q, v): gravity, Coriolis and centripetal terms, as options.effects has them.
/// M v̇ + b = τ. `bodies`: of whole trees.
void computeBias(const Model& model, const Kinematics& kinematics, const MassMatrix& inertia,
                 Segments bodies, RneaWorkspace& work, VectorX& bias);
inline void computeBias(const Model& model, const Kinematics& kinematics, const MassMatrix& inertia,
                        RneaWorkspace& work, VectorX& bias) {
  const Segment all = allBodies(model);
  computeBias(model, kinematics, inertia, {&all, 1}, work, bias);
}

/// The same for another velocity v in the same configuration.
void computeBiasAt(const Model& model, const Kinematics& kinematics, const MassMatrix& inertia,
                   const VectorX& v, Segments bodies, RneaWorkspace& work, VectorX& bias);
inline void computeBiasAt(const Model& model, const Kinematics& kinematics,
                          const MassMatrix& inertia, const VectorX& v, RneaWorkspace& work,
                          VectorX& bias) {
  const Segment all = allBodies(model);
  computeBiasAt(model, kinematics, inertia, v, {&all, 1}, work, bias);
}

/// τ = M v̇ + b by the recursion, never forming M (armature included).
void inverseDynamicsTree(const Model& model, const Kinematics& kinematics,
                         const MassMatrix& inertia, const VectorX& vdot, RneaWorkspace& work,
                         VectorX& tau);

}  // namespace softgauss

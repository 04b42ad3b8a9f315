// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Forward kinematics: poses, joint axes and velocities of all bodies.
///
/// Spatial vectors of a tree are in world axes about O (2.1): the origin of the tree's root body,
/// at q = 0 when that body slides.

#include <vector>

#include "softgauss/engine/core/segment.hpp"
#include "softgauss/engine/model/state.hpp"

namespace softgauss {

/// Stage written by computeKinematics().
struct Kinematics {
  std::vector<Transform> X_WB;  ///< (bodies) pose of each body
  std::vector<Vector3> p_WO;    ///< (trees) reference point O of each tree [m]
  std::vector<Motion> S;        ///< (nv) motion subspace of each dof, about O
  std::vector<Motion> V;        ///< (bodies) spatial velocity about O
  std::vector<Motion> A_bias;  ///< (bodies) spatial acceleration at v̇ = 0, without gravity: J̇ v
  /// (bodies) the velocity with which bodies turn through the step, where setMidstepVelocity() has
  /// predicted one; else it is V. A_bias is of it.
  std::vector<Motion> V_midstep;
  bool hasMidstep = false;

  const std::vector<Motion>& midstepVelocities() const { return hasMidstep ? V_midstep : V; }

  Kinematics() = default;
  explicit Kinematics(const Model& model);
};

/// All bodies but the world.
inline Segment allBodies(const Model& model) { return {1, model.bodyCount()}; }

/// Poses and axes from q; `bodies`, here and below: of whole trees.
void computePoses(const Model& model, const VectorX& q, Segments bodies, Kinematics& kinematics);
inline void computePoses(const Model& model, const VectorX& q, Kinematics& kinematics) {
  const Segment all = allBodies(model);
  computePoses(model, q, {&all, 1}, kinematics);
}
/// These, and velocities from v, also those of turning.
void computeKinematics(const Model& model, const State& state, Segments bodies,
                       Kinematics& kinematics);
inline void computeKinematics(const Model& model, const State& state, Kinematics& kinematics) {
  const Segment all = allBodies(model);
  computeKinematics(model, state, {&all, 1}, kinematics);
}

/// Velocities and bias accelerations of bodies for the joint velocity v, at the poses of k.
void computeVelocities(const Model& model, const Kinematics& k, const VectorX& v, Segments bodies,
                       std::vector<Motion>& V, std::vector<Motion>& A_bias);

/// What turns, does so by this velocity (nv): Coriolis forces and J̇ v are of it, V of State::v.
void setMidstepVelocity(const Model& model, const VectorX& v, Segments bodies, Kinematics& k);
inline void setMidstepVelocity(const Model& model, const VectorX& v, Kinematics& k) {
  const Segment all = allBodies(model);
  setMidstepVelocity(model, v, {&all, 1}, k);
}

/// Pose of a named frame in the world.
inline Transform framePose(const Model& model, const Kinematics& k, int frame) {
  const Frame& f = model.frames[static_cast<std::size_t>(frame)];
  return k.X_WB[static_cast<std::size_t>(f.body)] * f.X_BF;
}

/// Velocity [m/s] of the point of `body` that is now at p_WP.
Vector3 pointVelocity(const Model& model, const Kinematics& k, int body, const Vector3& p_WP);

/// The same of the velocity of turning.
Vector3 pointMidstepVelocity(const Model& model, const Kinematics& k, int body,
                             const Vector3& p_WP);

/// The same, and the acceleration at v̇ = 0 of pointBiasAcceleration().
struct MidstepPoint {
  Vector3 velocity, bias;
};
MidstepPoint midstepPoint(const Model& model, const Kinematics& k, int body, const Vector3& p_WP);

/// Acceleration [m/s²] at v̇ = 0 (that is, J̇ v, of turning) of the point of `body` that is now at
/// p_WP.
Vector3 pointBiasAcceleration(const Model& model, const Kinematics& k, int body,
                              const Vector3& p_WP);

}  // namespace softgauss

// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How axes, velocities and accelerations of bodies change with a coordinate q_j, on the manifold.
///
/// A change of q_j carries along all that dof j moves, against λ: the parent's body, or of a
/// floating joint the world for its translations and, for its rotations, the body as it translates.
/// About a point that does not move with it, for dofs k and bodies b that j moves,
///
///   δS_k = S_j × S_k,   δV_b = S_j × (V_b − V_λ)
///   δA_b = S_j × (A_b − A_λ) + (V_λ × S_j) × (V_b − V_λ)                                  (D.1)
///
/// with A = Σ S a + Ṡ v; without Ṡ v, the second term is not there. The three rotations of one
/// floating joint move each other's axes.

#include <vector>

#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss {

/// Whether i and j are rotations of one floating joint.
inline bool areRotationsOfOneJoint(const Model& model, int i, int j) {
  const Dof& dof = model.dofs[idx(i)];
  if (dof.body != model.dofs[idx(j)].body) return false;
  const Body& body = model.bodies[idx(dof.body)];
  return body.joint == JointKind::floating && i - body.v >= 3 && j - body.v >= 3;
}

/// Whether q_j moves the axis of dof i, j at or above i.
inline bool movesAxis(const Model& model, int j, int i) {
  return j != i && (j < i || areRotationsOfOneJoint(model, i, j));
}

/// X_λ of dof j, for motions X of bodies: velocities, or accelerations. `world` is that of the
/// world, `translation` what the translations of a floating joint add to it, by dofs (nv).
template <class Translation>
Motion motionAgainst(const Model& model, int j, const std::vector<Motion>& X, const Motion& world,
                     const Translation& translation) {
  const Body& body = model.bodies[idx(model.dofs[idx(j)].body)];
  if (body.joint != JointKind::floating) return body.parent == 0 ? world : X[idx(body.parent)];
  Motion against = world;
  if (j - body.v >= 3) against.linear += translation.template segment<3>(body.v);
  return against;
}

}  // namespace softgauss

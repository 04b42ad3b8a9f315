// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Joint accelerations with the motions of bodies that they make, and forces on bodies with the
/// joint forces that these are: one sweep outwards, one inwards, in O(n).
///
///   A_b = A_parent + Σ S_i a_i,       τ_i = S_iᵀ Σ F over the subtree of the body of i
///
/// A row that is a force on a body and its opposite on another has J a from their two A_b, and its
/// Jᵀf is f on the two F_b before the sweep: J is never made.

#include <vector>

#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

/// An acceleration, or a direction: of joints and of bodies (spatial, about O of their trees).
struct BodyMotion {
  const VectorX& joint;             ///< (nv)
  const std::vector<Motion>& body;  ///< (bodies)
};

/// A force: on joints, and on bodies.
struct BodyForce {
  VectorX& joint;            ///< (nv)
  std::vector<Force>& body;  ///< (bodies)
};

/// A_b of these bodies, of whole trees, for the joint acceleration a, without Ṡ v.
void moveBodies(const Model& model, const Kinematics& k, Segments bodies, const VectorX& a,
                std::vector<Motion>& A);
inline void moveBodies(const Model& model, const Kinematics& k, const VectorX& a,
                       std::vector<Motion>& A) {
  const Segment all = allBodies(model);
  moveBodies(model, k, {&all, 1}, a, A);
}

/// tau ← tau + Σ S_iᵀ F, of forces on these bodies; these become those of subtrees.
void addBodyForces(const Model& model, const Kinematics& k, Segments bodies, std::vector<Force>& F,
                   VectorX& tau);
inline void addBodyForces(const Model& model, const Kinematics& k, std::vector<Force>& F,
                          VectorX& tau) {
  const Segment all = allBodies(model);
  addBodyForces(model, k, {&all, 1}, F, tau);
}

/// I_b A_b of these bodies.
void multiplyInertias(const Model& model, const MassMatrix& inertia, Segments bodies,
                      const std::vector<Motion>& A, std::vector<Force>& IA);

/// xᵀM x of one tree: twice its kinetic energy at the velocity x. `V` is scratch (bodies).
double twiceKineticEnergy(const Model& model, const Tree& tree, const Kinematics& k,
                          const MassMatrix& inertia, const VectorX& x, std::vector<Motion>& V);

}  // namespace softgauss

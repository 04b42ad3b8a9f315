// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Smooth forces: everything in  M a + c = τ + Jᵀ f  that no constraint makes (2.4).
///
///   c = b(q, v) + D v + K (q − q_s) − Σ J_Bᵀ F_B,   τ = applied generalised force
///
/// b: gravity, Coriolis and centripetal terms (rnea.hpp); D: joint damping; K: joint springs; F_B:
/// external wrenches, and weights that are borne (gravity_compensation.hpp).
/// c is the paper's c(q, v): all that does not depend on the control or the acceleration.

#include "softgauss/engine/dynamics/rnea.hpp"
#include "softgauss/engine/dynamics/tree_selection.hpp"
#include "softgauss/engine/model/plan.hpp"

namespace softgauss {

/// Stage written by computeSmoothForces().
struct SmoothForces {
  /// How often each was worked out since the start.
  struct Calls {
    std::int64_t gravity = 0, coriolis = 0, damping = 0, spring = 0, externalWrench = 0;
  };

  VectorX bias;  ///< b (nv)
  VectorX c;     ///< (nv)
  VectorX tau;   ///< applied, as Input::tau (nv)
  VectorX push;  ///< of wrenches, in c (nv)
  VectorX net;   ///< τ − c: M a_s
  RneaWorkspace work;
  Calls calls;

  SmoothForces() = default;
  SmoothForces(const Model& model, const Plan& plan)
      : bias(VectorX::Zero(model.nv)),
        c(VectorX::Zero(model.nv)),
        tau(VectorX::Zero(model.nv)),
        push(VectorX::Zero(model.nv)),
        net(VectorX::Zero(model.nv)),
        work(model, plan.gravity || plan.coriolis, plan.drifts) {}
};

/// Of these trees; what the stage has of others stays.
void computeSmoothForces(const Model& model, const Plan& plan, const State& state,
                         const Input& input, const Kinematics& kinematics,
                         const MassMatrix& inertia, const TreeSelection& trees,
                         SmoothForces& stage);

/// Replaces the applied force, e.g. by a control that was found after the other forces.
void setAppliedForce(const VectorX& tau, SmoothForces& stage);
/// The same on these dofs.
void setAppliedForce(Segments dofs, const VectorX& tau, SmoothForces& stage);

}  // namespace softgauss
